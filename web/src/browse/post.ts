/** What stands upright and slender, like a column: it is walked around. Pure; site frame. */

import type { Vector3 } from "../frames";

export interface Post {
  readonly e_m: number;
  readonly n_m: number;
  readonly radius_m: number;
  readonly bottom_m: number;
  readonly top_m: number;
}

/** Lower than this one looks over it, thicker than the second it is a wall, and of those the ground knows. */
const LEAST_HEIGHT_M = 1.4;
const MOST_WIDTH_M = 2;
const SLENDER = 2.5;
/** A shaft is thinner than its base and capital, which are what a box tells. */
const SHAFT = 0.8;

/** Return what fills a box between two corners, if it is a post. */
export function postIn(low: Vector3, high: Vector3): Post | null {
  const [width_m, depth_m, height_m] = [high[0] - low[0], high[1] - low[1], high[2] - low[2]];
  const widest_m = Math.max(width_m, depth_m);
  if (height_m < LEAST_HEIGHT_M || widest_m > MOST_WIDTH_M || height_m < SLENDER * widest_m) return null;
  return {
    e_m: (low[0] + high[0]) / 2,
    n_m: (low[1] + high[1]) / 2,
    radius_m: (SHAFT * Math.min(width_m, depth_m)) / 2,
    bottom_m: low[2],
    top_m: high[2],
  };
}
