/**
 * The model as a camera would take it: as bright as the picture is, and in its cast of colour. Pure.
 *
 * What comes out is a factor for each of the model's linear colours; the picture itself is never touched. Brightness follows the
 * picture's mean, its cast the grey world's: a scene is grey in the mean, so what is not is the light's, or the camera's, doing.
 */

import type { Vector3 } from "./frames";

/** Mean light, linear, of a picture as the model's colours were chosen for: a sunny square, exposed well. */
const USUAL_LIGHT = 0.3;
const DARKEST_LIGHT = 1e-3;
/** The ground and the sky have colours of their own: half of a cast is theirs. */
const BELIEVED = 0.5;
const CAST: readonly [number, number] = [0.8, 1.25];
const GAIN: readonly [number, number] = [0.2, 2];
/** Two thirds of a change are made up for in this time; nearly all in a second. */
const LAG_S = 0.35;

/** Return the mean red, green and blue of sRGB pixels (RGBA bytes) as linear light, 0 to 1. */
export function meanLight(rgba: Uint8ClampedArray): Vector3 {
  const sum = [0, 0, 0];
  for (let i = 0; i + 3 < rgba.length; i += 4)
    for (let colour = 0; colour < 3; colour++) sum[colour] = (sum[colour] ?? 0) + (LINEAR[rgba[i + colour] ?? 0] ?? 0);
  const count = Math.max(1, rgba.length >> 2);
  const [r = 0, g = 0, b = 0] = sum;
  return [r / count, g / count, b / count];
}

/** Return the factors that a picture of this mean light asks for; `daylight` is the scene's light over the usual one. */
export function gainFor([r, g, b]: Vector3, daylight = 1): Vector3 {
  const light = Math.max(DARKEST_LIGHT, luminance([r, g, b]));
  const gain = clamp(light / (USUAL_LIGHT * Math.max(0.02, daylight)), GAIN);
  const cast = [r, g, b].map((value) => clamp((Math.max(DARKEST_LIGHT, value) / light) ** BELIEVED, CAST));
  const [cr = 1, cg = 1, cb = 1] = cast;
  const kept = luminance([cr, cg, cb]);
  return [(gain * cr) / kept, (gain * cg) / kept, (gain * cb) / kept];
}

/** Follows what pictures ask for, without flicker. */
export class Matching {
  /** The factors now. */
  gain: Vector3 = [1, 1, 1];
  private last_ms: number | null = null;

  /** Take what a picture asks for; the first one is obeyed at once. */
  take(wanted: Vector3, now_ms: number): Vector3 {
    const passed_s = this.last_ms === null ? Number.POSITIVE_INFINITY : Math.max(0, now_ms - this.last_ms) / 1000;
    const share = 1 - Math.exp(-passed_s / LAG_S);
    this.last_ms = now_ms;
    // in steps of ratio, as eyes see brightness
    this.gain = this.gain.map((now, i) => now * ((wanted[i] ?? 1) / now) ** share) as unknown as Vector3;
    return this.gain;
  }
}

function luminance([r, g, b]: Vector3): number {
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function clamp(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, value));
}

const LINEAR: readonly number[] = Array.from({ length: 256 }, (_, level) => {
  const value = level / 255;
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
});
