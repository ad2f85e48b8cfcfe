/** How well is drawn while something moves: as well as keeps up with the eye. Pure; times are milliseconds. */

export interface Step {
  /** Share of the screen's own pixels along each side. */
  readonly fineness: number;
  /** Surfaces lit at their corners, and the coarsest level of the model alone. */
  readonly plain: boolean;
}

/** What is at rest is drawn so, whatever it takes. */
export const BEST: Step = { fineness: 1, plain: false };
/** From the best to the cheapest. */
export const STEPS: readonly Step[] = [
  BEST,
  { fineness: 0.75, plain: false },
  { fineness: 0.55, plain: false },
  { fineness: 0.5, plain: true },
];

/** Slower than this, in the middle, is too slow; one picture that is much slower is enough to know. */
const SLOW_MS = 42;
const AWFUL_MS = 250;
/** Faster than this there is time to spare. */
const SPARE_MS = 22;
const LOOKED_AT = 6;
/** After a step was too slow it is not tried again for so long, each time twice as long. */
const PATIENCE_MS = 8000;
const MOST_PATIENCE_MS = 512_000;

/** Without a graphics card so much of the time is left to others after a picture of who moves: in shares of what it took to come. */
const LEFT = { whole: 1, loading: 3 } as const;
const MOST_LEFT_MS = 250;

/** Return how long to draw nothing after a picture that took so long to come: other pages draw and load, too. */
export function breakAfter(took_ms: number, isWhole: boolean): number {
  return Math.min(MOST_LEFT_MS, took_ms * (isWhole ? LEFT.whole : LEFT.loading));
}

export class Pace {
  private index: number;
  private times_ms: number[] = [];
  private barred_ms = Number.NEGATIVE_INFINITY;
  private patience_ms = PATIENCE_MS;

  /** `inSoftware`: there is no graphics card. */
  constructor(inSoftware: boolean) {
    this.index = inSoftware ? STEPS.length - 1 : 0;
  }

  get step(): Step {
    return STEPS[this.index] ?? BEST;
  }

  /** Take note of how long after the last one a picture of a motion came. */
  drawn(since_ms: number, now_ms: number): void {
    this.times_ms.push(since_ms);
    if (since_ms > AWFUL_MS) this.go(STEPS.length - 1, now_ms);
    if (this.times_ms.length < LOOKED_AT) return;
    const middle = [...this.times_ms].sort((a, b) => a - b)[LOOKED_AT >> 1] ?? 0;
    if (middle > SLOW_MS) this.go(this.index + 1, now_ms);
    else if (middle < SPARE_MS && now_ms >= this.barred_ms) this.go(this.index - 1, now_ms);
    else this.times_ms.shift();
  }

  private go(index: number, now_ms: number): void {
    this.times_ms = [];
    const next = Math.min(STEPS.length - 1, Math.max(0, index));
    if (next > this.index) {
      this.barred_ms = now_ms + this.patience_ms;
      this.patience_ms = Math.min(2 * this.patience_ms, MOST_PATIENCE_MS);
    }
    this.index = next;
  }
}
