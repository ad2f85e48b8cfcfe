/**
 * Choosing by looking, without hands and without a voice. Pure; times are milliseconds.
 *
 * To look at one's feet for a while opens the menu. Its things then hang in the world side by side about where one looks up
 * again; to look at one for a while chooses it, to look far past them puts them away.
 */

/** Nobody looks this far down for so long but on purpose: 38 degrees below the horizon. */
const DOWN_RAD = (38 * Math.PI) / 180;
const OPENS_AFTER_MS = 1500;
export const CHOOSES_AFTER_MS = 1300;
/** Between two things of the menu. */
export const APART_RAD = (16 * Math.PI) / 180;
/** Within this of its middle a thing is looked at. */
const NEAR_RAD = (6 * Math.PI) / 180;
const PAST_RAD = (30 * Math.PI) / 180;
/** Nobody is left with a menu before the eyes. */
const CLOSES_AFTER_MS = 15_000;

export interface Looked {
  readonly event: "open" | "close" | { readonly chosen: number } | null;
  /** What is looked at; null for nothing. */
  readonly at: number | null;
  /** How much of the time that it takes is over, 0 to 1. */
  readonly progress: number;
}

const NOTHING: Looked = { event: null, at: null, progress: 0 };

export class Gaze {
  private open = false;
  private middle_rad: number | null = null;
  private since_ms: number | null = null;
  private at: number | null = null;
  private opened_ms = 0;

  constructor(private readonly things: number) {}

  get isOpen(): boolean {
    return this.open;
  }

  /** How far each thing is to the right of where one looks, radians; null before the head is up again. */
  places(heading_rad: number): readonly number[] | null {
    const { middle_rad } = this;
    if (!this.open || middle_rad === null) return null;
    return Array.from({ length: this.things }, (_, i) =>
      turned(middle_rad + (i - (this.things - 1) / 2) * APART_RAD - heading_rad),
    );
  }

  /** Take where one looks: `pitch_rad` above the horizon, heading clockwise from north. */
  take(pitch_rad: number, heading_rad: number, now_ms: number): Looked {
    return this.open ? this.choose(pitch_rad, heading_rad, now_ms) : this.wake(pitch_rad, now_ms);
  }

  /** Put the menu away. */
  close(): void {
    this.open = false;
    this.since_ms = this.at = this.middle_rad = null;
  }

  private wake(pitch_rad: number, now_ms: number): Looked {
    if (pitch_rad > -DOWN_RAD) {
      this.since_ms = null;
      return NOTHING;
    }
    this.since_ms ??= now_ms;
    const progress = Math.min(1, (now_ms - this.since_ms) / OPENS_AFTER_MS);
    if (progress < 1) return { event: null, at: null, progress };
    this.close();
    this.open = true;
    this.opened_ms = now_ms;
    return { event: "open", at: null, progress: 0 };
  }

  private choose(pitch_rad: number, heading_rad: number, now_ms: number): Looked {
    if (now_ms - this.opened_ms > CLOSES_AFTER_MS) return this.away();
    if (this.middle_rad === null) {
      if (pitch_rad < -DOWN_RAD / 2) return NOTHING; // still on the way up
      this.middle_rad = heading_rad;
    }
    const places = this.places(heading_rad) ?? [];
    if (places.every((place) => Math.abs(place) > PAST_RAD)) return this.away();
    const near = places.findIndex((place) => Math.abs(place) < NEAR_RAD);
    const at = near < 0 ? null : near;
    if (at !== this.at) [this.at, this.since_ms] = [at, now_ms];
    if (at === null || this.since_ms === null) return NOTHING;
    const progress = Math.min(1, (now_ms - this.since_ms) / CHOOSES_AFTER_MS);
    if (progress < 1) return { event: null, at, progress };
    this.close();
    return { event: { chosen: at }, at, progress: 1 };
  }

  private away(): Looked {
    this.close();
    return { event: "close", at: null, progress: 0 };
  }
}

function turned(angle_rad: number): number {
  return Math.atan2(Math.sin(angle_rad), Math.cos(angle_rad));
}
