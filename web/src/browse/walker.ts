/**
 * How one walks: over the ground, along walls, never through them nor down from a height. Pure; site frame.
 *
 * The same start and the same intents give the same path: nothing here knows the time but by the steps that it is given.
 */

import type { Vector3 } from "../frames";
import { BODY_M, type Ground } from "./ground";
import type { Intent } from "./intent";

export interface Walker {
  /** Where the feet are. */
  readonly feet_site_m: Vector3;
  readonly v_e_m_s: number;
  readonly v_n_m_s: number;
  /** Height of the eyes; stairs do not shake it. */
  readonly eyes_m: number;
}

const WALK_M_S = 1.9;
const RUN_M_S = 5.5;
/** A step up or down that one takes without noticing; stairs are slopes in the model of the ground. */
export const STEP_M = 0.35;
/** One moves by less than half a body at a time, so that nothing thicker than that is stepped through. */
export const STRIDE_M = BODY_M / 2;
/** Time constants: until the speed is the wanted one, and the eyes are as high as they stand. */
const PUSH_S = 0.1;
const RISE_S = 0.14;
const LONGEST_STEP_S = 0.1;
/** Ways beside the wanted one that are tried along a wall, nearest first. */
const ASIDE_RAD = [0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9, 1.2, -1.2, 1.45, -1.45] as const;
const REST_M_S = 0.02;

/** Return somebody who stands still. */
export function standing(feet_site_m: Vector3, eyeHeight_m: number): Walker {
  return { feet_site_m, v_e_m_s: 0, v_n_m_s: 0, eyes_m: feet_site_m[2] + eyeHeight_m };
}

/** Return the walker a moment later; `heading_rad` is where ahead is. */
export function walk(
  walker: Walker,
  intent: Intent,
  heading_rad: number,
  ground: Ground,
  eyeHeight_m: number,
  dt_s: number,
): Walker {
  const dt = Math.min(LONGEST_STEP_S, Math.max(0, dt_s));
  const [sin, cos] = [Math.sin(heading_rad), Math.cos(heading_rad)];
  const share = 1 / Math.max(1, Math.hypot(intent.ahead, intent.right));
  const speed = share * (intent.hurry ? RUN_M_S : WALK_M_S);
  const settle = Math.exp(-dt / PUSH_S);
  const towards = (now: number, wanted: number): number => wanted + (now - wanted) * settle;
  const v_e = towards(walker.v_e_m_s, speed * (intent.ahead * sin + intent.right * cos));
  const v_n = towards(walker.v_n_m_s, speed * (intent.ahead * cos - intent.right * sin));
  const length_m = Math.hypot(v_e, v_n) * dt;
  const strides = Math.ceil(length_m / STRIDE_M);
  let feet = walker.feet_site_m;
  for (let i = 0; i < strides; i++) feet = stride(feet, Math.atan2(v_e, v_n), length_m / strides, ground);
  const eyes = feet[2] + eyeHeight_m + (walker.eyes_m - feet[2] - eyeHeight_m) * Math.exp(-dt / RISE_S);
  if (strides === 0) return { feet_site_m: feet, v_e_m_s: v_e, v_n_m_s: v_n, eyes_m: eyes };
  // as fast as one came forward: who was held up by a wall does not shoot off when it ends
  const [came_e, came_n] = [feet[0] - walker.feet_site_m[0], feet[1] - walker.feet_site_m[1]];
  return { feet_site_m: feet, v_e_m_s: came_e / dt, v_n_m_s: came_n / dt, eyes_m: eyes };
}

/** Whether nothing changes any more without an intent. */
export function isAtRest({ feet_site_m, v_e_m_s, v_n_m_s, eyes_m }: Walker, eyeHeight_m: number): boolean {
  return Math.hypot(v_e_m_s, v_n_m_s) < REST_M_S && Math.abs(eyes_m - feet_site_m[2] - eyeHeight_m) < 0.002;
}

/** Return where one comes by one stride: straight on, else along what is in the way, else nowhere. */
function stride(feet: Vector3, heading_rad: number, length_m: number, ground: Ground): Vector3 {
  for (const aside_rad of ASIDE_RAD) {
    const way_m = length_m * Math.cos(aside_rad);
    const e = feet[0] + way_m * Math.sin(heading_rad + aside_rad);
    const n = feet[1] + way_m * Math.cos(heading_rad + aside_rad);
    const z = ground.heightAt([e, n], feet[2] - STEP_M, feet[2] + STEP_M);
    if (z !== null) return [e, n, z];
  }
  return feet;
}
