/**
 * Whether a walker is seen to move. Who stands still stands still on the page, too: their pose trembles, and a page that draws
 * every trembling never has the time for its finest picture. Pure.
 */

import { angleBetween, length, minus, type Place } from "./between";
import type { Shown } from "./poses";

/** Less is not seen from where one stands beside a walker. */
const MOVES_M = 0.02;
const MOVES_RAD = 0.009;
/** A doubt that has grown by less is drawn with the next motion. */
const DOUBTS_M = 0.1;
const AFTER_MS = 500;

export class Rest {
  private held: Shown | null = null;
  private moved_ms = Number.NEGATIVE_INFINITY;
  private moving = false;

  /** Whether something was seen to change a moment ago. */
  get moves(): boolean {
    return this.moving;
  }

  /** Return the place to show: the walker's own, or where they stand. */
  at(shown: Shown, now_ms: number): Place {
    if (this.held === null || differs(this.held, shown)) {
      this.held = shown;
      this.moved_ms = now_ms;
    }
    const moves = now_ms - this.moved_ms < AFTER_MS;
    if (this.moving && !moves) this.held = shown; // they come to rest where they are
    this.moving = moves;
    return moves ? shown : this.held;
  }
}

function differs(a: Shown, b: Shown): boolean {
  return (
    length(minus(a.p_site_body_m, b.p_site_body_m)) > MOVES_M ||
    angleBetween(a.wxyz_site_body, b.wxyz_site_body) > MOVES_RAD ||
    a.told.motionModel !== b.told.motionModel ||
    a.told.headingKnown !== b.told.headingKnown ||
    Math.abs(doubtOf(a) - doubtOf(b)) > DOUBTS_M
  );
}

function doubtOf({ told: { variance } }: Shown): number {
  return Math.sqrt(Math.max(0, variance[0] ?? 0, variance[1] ?? 0));
}
