/**
 * The pose at a moment between two poses that a rig has told, and shortly after the newest. Pure.
 *
 * Positions follow a cubic Hermite curve by the velocities that the rig told, held back to what its positions bear out: a
 * velocity that is off by more than the way between both poses bends the curve no further. So the curve goes through both
 * poses, is never faster than twice the straight way at an even pace, and leaves that way by at most a quarter of its length.
 */

import type { Vector3 } from "../frames";

/** Unit quaternion, w first, as on the wire. */
export type Wxyz = readonly [number, number, number, number];

/** What of a told pose its place depends on. */
export interface Told {
  readonly t_ns: number;
  readonly p_site_body_m: Vector3;
  readonly wxyz_site_body: Wxyz;
  readonly v_site_m_s: Vector3;
}

/** Where the rig is shown. */
export interface Place {
  readonly p_site_body_m: Vector3;
  readonly wxyz_site_body: Wxyz;
}

/** Beyond this after the newest pose nothing is guessed: the rig stands where it was told last. */
export const HORIZON_NS = 150e6;

/** Return the place at `t_ns`, between `a` and the later `b`. */
export function between(a: Told, b: Told, t_ns: number): Place {
  const whole_ns = b.t_ns - a.t_ns;
  const u = Math.min(1, Math.max(0, (t_ns - a.t_ns) / whole_ns));
  const way = minus(b.p_site_body_m, a.p_site_body_m);
  const most_m = length(way);
  const bend = (velocity: Vector3): Vector3 => within(minus(scaled(velocity, whole_ns * 1e-9), way), most_m);
  const straight = plus(a.p_site_body_m, scaled(way, u));
  const first = scaled(bend(a.v_site_m_s), u * (1 - u) ** 2);
  const last = scaled(bend(b.v_site_m_s), -(1 - u) * u ** 2);
  return {
    p_site_body_m: plus(straight, plus(first, last)),
    wxyz_site_body: slerp(a.wxyz_site_body, b.wxyz_site_body, u),
  };
}

/**
 * Return the place at `t_ns`, after the newest pose: a little onward at its velocity, and back to it when nothing new comes.
 *
 * The rig is shown at most 4/27 of the horizon ahead of what it told: 3 cm for a walker, who may have stopped meanwhile.
 */
export function onward(newest: Told, t_ns: number): Place {
  const { p_site_body_m, wxyz_site_body, v_site_m_s } = newest;
  const share = Math.min(1, Math.max(0, (t_ns - newest.t_ns) / HORIZON_NS));
  const ahead_s = share * (1 - share) ** 2 * HORIZON_NS * 1e-9;
  return { p_site_body_m: plus(p_site_body_m, scaled(v_site_m_s, ahead_s)), wxyz_site_body };
}

/** Return the rotation a share of the way from `a` to `b`, by the shorter way at an even pace. */
export function slerp(a: Wxyz, b: Wxyz, share: number): Wxyz {
  const along = dot4(a, b);
  const sign = along < 0 ? -1 : 1;
  const angle_rad = Math.acos(Math.min(1, Math.abs(along)));
  // closer than this the sines below would divide nearly nothing by nearly nothing, and the chord is the arc
  const [of_a, of_b] =
    angle_rad < 1e-4
      ? [1 - share, share]
      : [Math.sin((1 - share) * angle_rad) / Math.sin(angle_rad), Math.sin(share * angle_rad) / Math.sin(angle_rad)];
  return unit([
    of_a * a[0] + sign * of_b * b[0],
    of_a * a[1] + sign * of_b * b[1],
    of_a * a[2] + sign * of_b * b[2],
    of_a * a[3] + sign * of_b * b[3],
  ]);
}

/** Return the rotation `b`, then `a`. */
export function turned(a: Wxyz, b: Wxyz): Wxyz {
  const [aw, ax, ay, az] = a;
  const [bw, bx, by, bz] = b;
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

/** Return the rotation backwards. */
export function back([w, x, y, z]: Wxyz): Wxyz {
  return [w, -x, -y, -z];
}

/** Return the angle between two rotations, [0, pi]. */
export function angleBetween(a: Wxyz, b: Wxyz): number {
  return 2 * Math.acos(Math.min(1, Math.abs(dot4(a, b))));
}

/** Return `a + b`. */
export function plus(a: Vector3, b: Vector3): Vector3 {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

/** Return `a - b`. */
export function minus(a: Vector3, b: Vector3): Vector3 {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

/** Return a vector times a number. */
export function scaled(a: Vector3, factor: number): Vector3 {
  return [factor * a[0], factor * a[1], factor * a[2]];
}

/** Return how long a vector is. */
export function length(a: Vector3): number {
  return Math.hypot(...a);
}

/** Return `a`, shortened to at most `most`. */
function within(a: Vector3, most: number): Vector3 {
  const long = length(a);
  return long <= most ? a : scaled(a, most / long);
}

function dot4(a: Wxyz, b: Wxyz): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

function unit(q: Wxyz): Wxyz {
  const long = Math.hypot(...q);
  return [q[0] / long, q[1] / long, q[2] / long, q[3] / long];
}
