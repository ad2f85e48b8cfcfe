/** A distance between two points of the site. Pure. */

import type { Vector3 } from "../frames";

/** None, the first, or both points. */
export type Span = readonly Vector3[];

export interface Lengths {
  readonly far_m: number;
  /** On the plan. */
  readonly level_m: number;
  /** Upwards from the first to the second. */
  readonly high_m: number;
}

/** Return how far both points are apart; null where there are not two. */
export function lengthsOf([from, to]: Span): Lengths | null {
  if (!from || !to) return null;
  const [e, n, u] = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
  return { far_m: Math.hypot(e, n, u), level_m: Math.hypot(e, n), high_m: u };
}
