/** Where the others are shown, who say so a few times a second: each comes to its new place within that time. Pure. */

import { type Eye, turnTo } from "../browse/eye";
import type { Companion } from "../messages.gen";
import { length, minus } from "./between";
import { mixed } from "./gaze";

/** A share of the way that is left is gone in each of these times. */
const COME_MS = 150;
/** Who is further away than this has flown there, and nobody sees them cross the square. */
const JUMP_M = 15;
const REST_M = 0.005;
const REST_RAD = 0.005;

export class Glide {
  private readonly shown = new Map<number, Eye>();
  private last_ms = 0;

  /** Return everybody who is there in the next picture, by number. */
  at(others: readonly Companion[], now_ms: number): ReadonlyMap<number, Eye> {
    const share = 1 - Math.exp(-Math.max(0, now_ms - this.last_ms) / COME_MS);
    this.last_ms = now_ms;
    for (const number of this.shown.keys())
      if (!others.some((other) => other.number === number)) this.shown.delete(number);
    for (const { number, eye } of others) this.shown.set(number, nearer(this.shown.get(number), eye, share));
    return this.shown;
  }

  /** Whether all are where they said. */
  isAtRest(others: readonly Companion[]): boolean {
    return others.every(({ number, eye }) => {
      const shown = this.shown.get(number);
      if (!shown) return false;
      const turn_rad = Math.abs(turnTo(shown.heading_rad, eye.heading_rad)) + Math.abs(eye.pitch_rad - shown.pitch_rad);
      return length(minus(eye.place_site_m, shown.place_site_m)) < REST_M && turn_rad < REST_RAD;
    });
  }
}

function nearer(from: Eye | undefined, to: Eye, share: number): Eye {
  const way = from && minus(to.place_site_m, from.place_site_m);
  if (!from || !way || length(way) > JUMP_M) return to;
  return mixed(from, to, share);
}
