/**
 * Which moment of a walk is shown now: a little in the past, so that poses before and after it have come. Pure: times come in.
 *
 * The rig's clock and this browser's share no zero: the fastest of the last messages sets it, as in `playback.ts`. How far in the
 * past is what the last two seconds' messages needed, and never more than a limit: who waits longer sees an old pose, and
 * `between.ts` bridges the little that a message is later than that. The moment shown never goes back, and its clock runs at
 * half to one and a half of its own pace while it comes nearer to where it should be.
 */

import { HORIZON_NS } from "./between";

/** Of a live walk: with what a message and a picture take on a busy machine, a pose is a tenth of a second old at most. */
export const LIVE_DELAY_MS = 60;
/** Between a message's coming and its use there is the browser's own unrest. */
const MARGIN_MS = 4;
const FIRST_DELAY_MS = 45;
/** The clocks and the delay are judged by messages of so long; a silence of a quarter of it begins anew. */
const WINDOW_MS = 2000;
const SILENCE_MS = 500;
const SLOWEST = 0.5;
const FASTEST = 1.5;
/** So far behind, the moment jumps: a browser that slept has nothing to gain from walking it all. */
const LEAP_MS = 300;

interface Arrival {
  readonly arrived_ms: number;
  /** Arrival less the rig's time. */
  readonly transit_ms: number;
  readonly interval_ms: number;
}

export class Playout {
  private arrivals: Arrival[] = [];
  private newest_ms = Number.NEGATIVE_INFINITY;
  private fastest_ms = 0;
  private wait_ms = FIRST_DELAY_MS;
  private shown_ms: number | null = null;
  private asked_ms = 0;

  constructor(private readonly longest_ms = LIVE_DELAY_MS) {}

  /** How far in the past the moment is wanted. */
  get delay_ms(): number {
    return this.wait_ms;
  }

  /** Take note of a pose of the rig's time `t_ms` that has come now; those of one walk, in order. */
  take(t_ms: number, arrived_ms: number): void {
    const last = this.arrivals.at(-1);
    if (last && arrived_ms - last.arrived_ms > SILENCE_MS) this.arrivals = [];
    const interval_ms = this.arrivals.length > 0 ? t_ms - this.newest_ms : 0;
    this.arrivals.push({ arrived_ms, transit_ms: arrived_ms - t_ms, interval_ms });
    this.arrivals = this.arrivals.filter((arrival) => arrival.arrived_ms > arrived_ms - WINDOW_MS);
    this.newest_ms = t_ms;
    this.fastest_ms = Math.min(...this.arrivals.map(({ transit_ms }) => transit_ms));
    // until a message is there, the moment shown must not have passed the one before it
    const needs = this.arrivals.map(({ transit_ms, interval_ms: gap_ms }) => transit_ms - this.fastest_ms + gap_ms);
    if (needs.length > 1) this.wait_ms = Math.min(this.longest_ms, Math.max(...needs) + MARGIN_MS);
  }

  /** Return the moment to show at `now_ms`, on the rig's clock, ms; null before the first pose. */
  at(now_ms: number): number | null {
    if (this.arrivals.length === 0) return null;
    const elapsed_ms = Math.max(0, now_ms - this.asked_ms);
    this.asked_ms = Math.max(now_ms, this.asked_ms);
    const wanted_ms = now_ms - this.fastest_ms - this.wait_ms;
    // further than this after the newest nothing is guessed; and who pauses there goes on from there
    const end_ms = this.newest_ms + HORIZON_NS * 1e-6;
    const before_ms = this.shown_ms;
    if (before_ms === null || wanted_ms - before_ms > LEAP_MS) this.shown_ms = Math.min(wanted_ms, end_ms);
    else {
      const paced_ms = clamp(wanted_ms, before_ms + SLOWEST * elapsed_ms, before_ms + FASTEST * elapsed_ms);
      this.shown_ms = Math.max(before_ms, Math.min(paced_ms, end_ms));
    }
    return this.shown_ms;
  }

  /** Return how old the moment `t_ms` of the rig's clock is at `now_ms`. */
  age(t_ms: number, now_ms: number): number {
    return Math.max(0, now_ms - this.fastest_ms - t_ms);
  }
}

function clamp(value: number, least: number, most: number): number {
  return Math.min(Math.max(value, least), most);
}
