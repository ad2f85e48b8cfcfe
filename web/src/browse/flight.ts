/** A smooth way from one view to another, over the roofs where it is long. Pure; the time is given. */

import { type Eye, tilted, turned, turnTo } from "./eye";

export interface Flight {
  readonly duration_ms: number;
  /** Return where the eye is after so many milliseconds. */
  at(passed_ms: number): Eye;
}

const SHORTEST_MS = 700;
const LONGEST_MS = 3600;
const MS_PER_ROOT_M = 260;
/** A turn on the spot takes as long as this for each radian. */
const MS_PER_RAD = 450;
/** A flight that is longer than this rises, by a share of its length, and looks down a little meanwhile. */
const LEVEL_M = 15;
const RISE = 0.22;
const HIGHEST_M = 38;
const LOOK_DOWN_RAD = 0.3;

/** Return the flight between two eyes; who wants little motion is there at once. */
export function flightOf(from: Eye, to: Eye, isStill: boolean): Flight {
  const [e, n, u] = [0, 1, 2].map((i) => (to.place_site_m[i] ?? 0) - (from.place_site_m[i] ?? 0)) as [
    number,
    number,
    number,
  ];
  const length_m = Math.hypot(e, n, u);
  const turn_rad = turnTo(from.heading_rad, to.heading_rad);
  const wanted_ms = Math.max(SHORTEST_MS, MS_PER_ROOT_M * Math.sqrt(length_m), MS_PER_RAD * Math.abs(turn_rad));
  const duration_ms = isStill ? 0 : Math.min(LONGEST_MS, wanted_ms);
  const rise_m = Math.min(HIGHEST_M, RISE * Math.max(0, Math.hypot(e, n) - LEVEL_M));
  return {
    duration_ms,
    at: (passed_ms) => {
      if (passed_ms >= duration_ms) return to;
      const s = smooth(Math.max(0, passed_ms) / duration_ms);
      const over = 4 * s * (1 - s);
      const [e0, n0, u0] = from.place_site_m;
      const down = LOOK_DOWN_RAD * over * (rise_m / HIGHEST_M);
      return {
        place_site_m: [e0 + s * e, n0 + s * n, u0 + s * u + rise_m * over],
        heading_rad: turned(from.heading_rad + s * turn_rad),
        pitch_rad: tilted(from.pitch_rad + s * (to.pitch_rad - from.pitch_rad) - down),
      };
    },
  };
}

/** Begin and end without a jerk. */
function smooth(t: number): number {
  return t * t * t * (10 - 15 * t + 6 * t * t);
}
