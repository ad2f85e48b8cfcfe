/**
 * How surely the square may be drawn: the style of the overlay by what the tracker says of its own doubt. Pure.
 *
 * `locked` is the square as it is, `ghost` a translucent outline of it, `guide` an arrow and a plan and no overlay at all.
 * A worse style comes at once. A better one comes when the doubt has been well below its limit for a second: so neither
 * flickers about a limit, and what is drawn as locked is always within the limit.
 */

import type { CameraPose } from "./wire";
import { headingSigma, horizontalSigma } from "./words";

export type Style = "locked" | "ghost" | "guide";

/** What the tracker says of one pose: one sigma. */
export interface Doubt {
  readonly place_m: number;
  readonly heading_rad: number;
}

const DEGREE = Math.PI / 180;
/** As far off as this, each style is still honest. A ghost further off than this would stand on other ruins. */
export const LIMITS: Readonly<Record<"locked" | "ghost", Doubt>> = {
  locked: { place_m: 1.5, heading_rad: 1.5 * DEGREE },
  ghost: { place_m: 8, heading_rad: 8 * DEGREE },
};
/** A better style needs this share of its limit, */
const ENTRY = 0.8;
/** for so long. */
export const DWELL_NS = 1_000_000_000;
/** Who comes back after longer than this, or from later, begins anew. */
const LONGEST_NS = 3_000_000_000;
const ORDER: readonly Style[] = ["locked", "ghost", "guide"];

/** Return the doubt of a pose; a heading that nothing has told is in infinite doubt. */
export function doubtOf({ covariance, headingKnown }: CameraPose): Doubt {
  return {
    place_m: horizontalSigma(covariance),
    heading_rad: headingKnown ? headingSigma(covariance) : Number.POSITIVE_INFINITY,
  };
}

/** Return the best style that a doubt allows, with `share` of each limit. */
export function styleAt({ place_m, heading_rad }: Doubt, share = 1): Style {
  const within = (limit: Doubt): boolean => place_m < share * limit.place_m && heading_rad < share * limit.heading_rad;
  return within(LIMITS.locked) ? "locked" : within(LIMITS.ghost) ? "ghost" : "guide";
}

/** The style from picture to picture. */
export class Certainty {
  private shown: Style | null = null;
  /** Since when each style has been allowed without a break. */
  private since_ns = new Map<Style, number>();
  private last_ns = 0;

  /** Take the doubt of the picture that was captured at `t_ns`, in order; return the style to draw it in. */
  take(doubt: Doubt, t_ns: number): Style {
    if (this.shown === null || t_ns < this.last_ns || t_ns - this.last_ns > LONGEST_NS) this.reset();
    this.last_ns = t_ns;
    const surely = rank(styleAt(doubt, ENTRY));
    for (const style of ORDER) {
      if (rank(style) < surely) this.since_ns.delete(style);
      else if (!this.since_ns.has(style)) this.since_ns.set(style, t_ns);
    }
    const allowed = styleAt(doubt);
    if (this.shown === null || rank(allowed) > rank(this.shown)) {
      this.shown = allowed;
      return allowed;
    }
    const better = ORDER.find((style) => t_ns - (this.since_ns.get(style) ?? Number.POSITIVE_INFINITY) >= DWELL_NS);
    if (better && rank(better) < rank(this.shown)) this.shown = better;
    return this.shown;
  }

  /** Begin anew: after a jump in time the first doubt decides. */
  reset(): void {
    this.shown = null;
    this.since_ns.clear();
  }
}

function rank(style: Style): number {
  return ORDER.indexOf(style);
}
