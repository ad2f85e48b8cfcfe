/** When to show the others where one looks from: at most a few times a second, and again while one stands still. Pure. */

import { type Eye, turnTo } from "../browse/eye";
import { length, minus } from "./between";

const SOONEST_MS = 250;
/** The server forgets who says nothing for ten seconds. */
const AGAIN_MS = 2000;
/** Less than this is not seen. */
const MOVED_M = 0.05;
const TURNED_RAD = 0.02;

export class Looks {
  private told: Eye | null = null;
  private told_ms = Number.NEGATIVE_INFINITY;

  /** Whether an eye is to be told now; if so, it counts as told. */
  isDue(eye: Eye, now_ms: number): boolean {
    const since_ms = now_ms - this.told_ms;
    if (since_ms < SOONEST_MS || (since_ms < AGAIN_MS && this.told !== null && isSame(eye, this.told))) return false;
    this.told = eye;
    this.told_ms = now_ms;
    return true;
  }

  /** Begin anew: nobody knows where one looks from. */
  forget(): void {
    this.told = null;
    this.told_ms = Number.NEGATIVE_INFINITY;
  }
}

function isSame(a: Eye, b: Eye): boolean {
  const turn_rad = Math.max(Math.abs(turnTo(a.heading_rad, b.heading_rad)), Math.abs(a.pitch_rad - b.pitch_rad));
  return length(minus(a.place_site_m, b.place_site_m)) < MOVED_M && turn_rad < TURNED_RAD;
}
