/** One button for everything: a short press is the next thing, a long one chooses it. Pure; times are milliseconds. */

export type Press = "next" | "choose";

/** Held this long, a press is long: it counts at once, not only when the button is let go. */
export const LONG_MS = 600;
/** Buttons bounce: a press that is shorter is none. */
const SHORTEST_MS = 20;

export class OneButton {
  private since_ms: number | null = null;
  private spent = false;

  /** The button goes down; a key that repeats goes down again and again. */
  down(now_ms: number): void {
    if (this.since_ms !== null) return;
    this.since_ms = now_ms;
    this.spent = false;
  }

  /** Time passes; returns a long press when it has become one. */
  held(now_ms: number): Press | null {
    if (this.since_ms === null || this.spent || now_ms - this.since_ms < LONG_MS) return null;
    this.spent = true;
    return "choose";
  }

  /** The button is let go. */
  up(now_ms: number): Press | null {
    const { since_ms, spent } = this;
    this.since_ms = null;
    if (since_ms === null || spent || now_ms - since_ms < SHORTEST_MS) return null;
    return now_ms - since_ms >= LONG_MS ? "choose" : "next";
  }

  /** How much of a long press is done, 0 to 1. */
  progress(now_ms: number): number {
    if (this.since_ms === null || this.spent) return 0;
    return Math.min(1, Math.max(0, now_ms - this.since_ms) / LONG_MS);
  }
}
