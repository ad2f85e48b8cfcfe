/**
 * What the overlay leaves of the real world to see: the ground ahead while walking, and everything near drops and steps. Pure.
 *
 * The rule is simple and errs on the side of the ground: who walks sees the next metres of it without overlay, and who may be
 * near an edge, the doubt of the place included, sees little of the overlay at all.
 */

import type { Vector3 } from "./frames";

/** How the overlay is held back. */
export interface Restraint {
  /** The ground is left clear up to this distance, metres. */
  readonly clear_m: number;
  /** How much of the overlay is left, 0 to 1. */
  readonly share: number;
  /** Whether an edge is the reason. */
  readonly nearEdge: boolean;
}

/** Who is faster than the first walks, and stands again below the second, m/s. */
const WALKS_M_S = 0.45;
const STANDS_M_S = 0.25;
/** Six steps: what one looks ahead at while walking. */
const CLEAR_M = 5;
/** What clears and comes back does so within about a second. */
const CLEARING_M_S = 8;
/** Nearer to an edge than the first the least of the overlay is left, beyond the second all of it. */
const NEAR_M = 1.5;
const FAR_M = 3.5;
const LEAST_SHARE = 0.12;
/** A doubt of more than this says nothing of edges any more: all the site would be near one. */
const MOST_DOUBT_M = 1.5;

/** Follows a visitor from picture to picture. */
export class Safety {
  private walks = false;
  private clear_m = 0;
  private last_ns: number | null = null;

  /**
   * Take the pose of the next picture; return how the overlay is held back in it.
   *
   * `edge_m` is how far the nearest edge is from where the visitor is thought to stand, within `doubt_m` (one sigma).
   */
  take(t_ns: number, v_site_m_s: Vector3, edge_m: number, doubt_m: number): Restraint {
    const speed_m_s = Math.hypot(v_site_m_s[0], v_site_m_s[1]);
    this.walks = speed_m_s > (this.walks ? STANDS_M_S : WALKS_M_S);
    const wanted_m = this.walks ? CLEAR_M : 0;
    const step_s = this.last_ns === null ? Number.POSITIVE_INFINITY : Math.abs(t_ns - this.last_ns) * 1e-9;
    this.last_ns = t_ns;
    // at once when walking begins: a ground that is cleared late is not cleared
    this.clear_m = Math.max(wanted_m, this.clear_m - CLEARING_M_S * step_s);
    const sure_m = edge_m - Math.min(doubt_m, MOST_DOUBT_M);
    const way = Math.min(1, Math.max(0, (sure_m - NEAR_M) / (FAR_M - NEAR_M)));
    return { clear_m: this.clear_m, share: LEAST_SHARE + (1 - LEAST_SHARE) * way, nearEdge: way < 0.5 };
  }
}
