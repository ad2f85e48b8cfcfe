/** How finely is drawn while something moves: as finely as keeps up with the eye. Pure; times are milliseconds. */

/** Shares of the screen's own pixels along each side. */
export const FINENESS: readonly number[] = [1, 0.75, 0.55];

/** Slower than this, in the middle, is too slow; faster than the second there is time to spare. */
const SLOW_MS = 42;
const SPARE_MS = 22;
const LOOKED_AT = 6;
/** After a step was too slow it is not tried again for so long, each time twice as long. */
const PATIENCE_MS = 8000;
/** A longer time is a pause, or work of the browser's own. */
const PAUSE_MS = 1000;

export class Pace {
  private index = 0;
  private times_ms: number[] = [];
  private barred_ms = Number.NEGATIVE_INFINITY;
  private patience_ms = PATIENCE_MS;

  get fineness(): number {
    return FINENESS[this.index] ?? 1;
  }

  /** Take note of how long after the last one a picture of a motion came. */
  drawn(since_ms: number, now_ms: number): void {
    if (since_ms > PAUSE_MS) return;
    this.times_ms.push(since_ms);
    if (this.times_ms.length < LOOKED_AT) return;
    const middle = [...this.times_ms].sort((a, b) => a - b)[LOOKED_AT >> 1] ?? 0;
    this.times_ms = [];
    if (middle > SLOW_MS && this.index < FINENESS.length - 1) {
      this.index += 1;
      this.barred_ms = now_ms + this.patience_ms;
      this.patience_ms *= 2;
    } else if (middle < SPARE_MS && this.index > 0 && now_ms >= this.barred_ms) this.index -= 1;
  }
}
