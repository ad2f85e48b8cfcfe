/** Where a visitor is in the virtual square and where they look. Pure; site frame, as in CONVENTIONS.md. */

import { column, type Matrix4, type Vector3 } from "../frames";

export interface Eye {
  readonly place_site_m: Vector3;
  /** Clockwise from north. */
  readonly heading_rad: number;
  /** Upwards from the level. */
  readonly pitch_rad: number;
}

/** Nobody looks straight up or down: the heading would be lost. */
export const STEEPEST_RAD = (85 * Math.PI) / 180;

/** Return the unit vector in which an eye looks. */
export function aheadOf({ heading_rad, pitch_rad }: Pick<Eye, "heading_rad" | "pitch_rad">): Vector3 {
  const flat = Math.cos(pitch_rad);
  return [flat * Math.sin(heading_rad), flat * Math.cos(heading_rad), Math.sin(pitch_rad)];
}

/** Return an eye at a place that looks at another one. */
export function looking(place_site_m: Vector3, at_site_m: Vector3): Eye {
  const [e, n, u] = [0, 1, 2].map((i) => (at_site_m[i] ?? 0) - (place_site_m[i] ?? 0)) as [number, number, number];
  return { place_site_m, heading_rad: turned(Math.atan2(e, n)), pitch_rad: tilted(Math.atan2(u, Math.hypot(e, n))) };
}

/** Return the point so many metres ahead. */
export function pointAhead(eye: Eye, distance_m: number): Vector3 {
  const ahead = aheadOf(eye);
  return eye.place_site_m.map((value, i) => value + distance_m * (ahead[i] ?? 0)) as unknown as Vector3;
}

/** Return the pose of a camera in that eye, held level: x right, y down, z forward. */
export function poseOf(eye: Eye): Matrix4 {
  const [sin, cos] = [Math.sin(eye.heading_rad), Math.cos(eye.heading_rad)];
  const [zx, zy, zz] = aheadOf(eye);
  const [e, n, u] = eye.place_site_m;
  const [xx, xy] = [cos, -sin];
  // y = z cross x
  const [yx, yy, yz] = [-zz * xy, zz * xx, zx * xy - zy * xx];
  return [xx, yx, zx, e, xy, yy, zy, n, 0, yz, zz, u, 0, 0, 0, 1];
}

/** Return the eye of a camera; how it is rolled is lost. */
export function eyeOf(T_site_cam: Matrix4): Eye {
  const [e, n, u] = column(T_site_cam, 2);
  const at = (i: number): number => T_site_cam[i] ?? Number.NaN;
  return {
    place_site_m: [at(3), at(7), at(11)],
    heading_rad: turned(Math.atan2(e, n)),
    pitch_rad: tilted(Math.atan2(u, Math.hypot(e, n))),
  };
}

/** Return a heading in [0, 2 pi). */
export function turned(heading_rad: number): number {
  const rest = heading_rad % (2 * Math.PI);
  return rest < 0 ? rest + 2 * Math.PI : rest;
}

/** Return a pitch that is not too steep. */
export function tilted(pitch_rad: number): number {
  return Math.min(STEEPEST_RAD, Math.max(-STEEPEST_RAD, pitch_rad));
}

/** Return the shorter way from one heading to another, (-pi, pi]. */
export function turnTo(from_rad: number, to_rad: number): number {
  const turn = turned(to_rad - from_rad);
  return turn > Math.PI ? turn - 2 * Math.PI : turn;
}
