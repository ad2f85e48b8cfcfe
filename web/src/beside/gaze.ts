/** Where a walker looks, and where a camera stands that looks with them or after them. Pure; site frame. */

import { type Eye, eyeOf, looking, turned, turnTo } from "../browse/eye";
import type { Matrix4, Vector3 } from "../frames";
import { minus, type Place, plus, scaled, type Wxyz } from "./between";

/** How far behind and above the eyes, and how far ahead of them the camera looks. */
const BEHIND_M = 5.2;
const ABOVE_M = 1.5;
const ARM_M = Math.hypot(BEHIND_M, ABOVE_M);
const AHEAD_M = 2;
const BELOW_M = 0.7;
/** Who turns their head does not swing the camera about with it: it comes after in this time. */
const TURN_S = 0.7;
/** So near to what stands behind the walker does the camera come; out again it goes in this time. */
const CLEAR_M = 0.35;
const OUT_S = 0.6;
/** What is left of a swing is not seen. */
const REST_RAD = 0.002;
const REST_M = 0.005;
const COME_MS = 900;

/** Return the rotation as three rows: body coordinates (x forward, y left, z up) to the site's. */
export function rowsOf([w, x, y, z]: Wxyz): readonly [Vector3, Vector3, Vector3] {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** Return the walker's eye, held level: who only watches grows dizzy from another's nodding. */
export function eyeOfWalker(walker: Place): Eye {
  return eyeOf(cameraOf(walker));
}

/** Return the pose of a camera in the walker's eye: x right, y down, z forward. */
function cameraOf({ p_site_body_m, wxyz_site_body }: Place): Matrix4 {
  const rows = rowsOf(wxyz_site_body).map(([forward, left, up], i) => [-left, -up, forward, p_site_body_m[i] ?? 0]);
  return [...rows.flat(), 0, 0, 0, 1];
}

/** Return which way the walker looks, clockwise from north. */
export function headingOfWalker({ wxyz_site_body }: Place): number {
  const [[e], [n]] = rowsOf(wxyz_site_body);
  return turned(Math.atan2(e, n));
}

/** Whether one goes with a walker or looks out of their eyes. */
export type Way = "follow" | "eyes";

/** A camera that goes with a walker, from where it was: it flies there first, or is there at once. */
export class Escort {
  private heading_rad: number | null = null;
  /** How far from the walker's eyes the camera is. */
  private arm_m = ARM_M;
  private swings = false;
  private last_ms: number;

  constructor(
    readonly way: Way,
    private readonly from: Eye,
    private readonly began_ms: number,
    private readonly isStill: boolean,
    private readonly reach: (from: Vector3, to: Vector3) => number,
  ) {
    this.last_ms = began_ms;
  }

  /** Whether it is where it wants to be. */
  get isAtRest(): boolean {
    return this.isThere(this.last_ms) && !this.swings;
  }

  /** Whether it has come. */
  isThere(now_ms: number): boolean {
    return this.shareAt(now_ms) >= 1;
  }

  /** Return the eye of the next picture. */
  at(walker: Place, now_ms: number): Eye {
    const wanted = this.way === "eyes" ? eyeOfWalker(walker) : this.behind(walker, now_ms);
    const share = this.shareAt(now_ms);
    this.last_ms = now_ms;
    return share >= 1 ? wanted : mixed(this.from, wanted, share * share * (3 - 2 * share));
  }

  private shareAt(now_ms: number): number {
    return this.isStill ? 1 : Math.min(1, Math.max(0, (now_ms - this.began_ms) / COME_MS));
  }

  private behind(walker: Place, now_ms: number): Eye {
    const wanted_rad = headingOfWalker(walker);
    const passed_s = Math.max(0, now_ms - this.last_ms) / 1000;
    const before_rad = this.heading_rad ?? wanted_rad;
    const left_rad = turnTo(before_rad, wanted_rad);
    const isTurned = Math.abs(left_rad) < REST_RAD;
    this.heading_rad = isTurned ? wanted_rad : turned(before_rad + shareIn(passed_s, TURN_S) * left_rad);
    const ahead: Vector3 = [Math.sin(this.heading_rad), Math.cos(this.heading_rad), 0];
    const eyes = walker.p_site_body_m;
    const arm = plus(scaled(ahead, -BEHIND_M), [0, 0, ABOVE_M]);
    const free_m = clearOf(this.reach(eyes, plus(eyes, arm)));
    const out_m = ARM_M - this.arm_m;
    const wanted_m = out_m < REST_M ? ARM_M : this.arm_m + shareIn(passed_s, OUT_S) * out_m;
    this.arm_m = Math.min(free_m, wanted_m);
    this.swings = !isTurned || this.arm_m < Math.min(free_m, ARM_M);
    return looking(
      plus(eyes, scaled(arm, this.arm_m / ARM_M)),
      plus(eyes, plus(scaled(ahead, AHEAD_M), [0, 0, -BELOW_M])),
    );
  }
}

/** Return how far out the camera may be where something stands so far away: before it always. */
function clearOf(hit_m: number): number {
  return Math.max(hit_m / 2, hit_m - CLEAR_M);
}

/** Return the share of a way that is gone in a time, of which a third is left after `third_s`. */
function shareIn(passed_s: number, third_s: number): number {
  return 1 - Math.exp(-passed_s / third_s);
}

/** Return an eye so far on the way to another. */
export function mixed(from: Eye, to: Eye, share: number): Eye {
  const way = minus(to.place_site_m, from.place_site_m);
  return {
    place_site_m: plus(from.place_site_m, scaled(way, share)),
    heading_rad: turned(from.heading_rad + share * turnTo(from.heading_rad, to.heading_rad)),
    pitch_rad: from.pitch_rad + share * (to.pitch_rad - from.pitch_rad),
  };
}
