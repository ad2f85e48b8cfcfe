/**
 * A walker's poses, from the wire to the picture: told in steps, shown without any. Pure: times come in.
 *
 * What is shown goes through every pose that comes in time. Where one came late, and the walker was shown a little onward
 * meanwhile, the difference fades within a few pictures instead of pulling the walker back.
 */

import type { PoseMessage } from "../wire";
import { angleBetween, back, between, length, minus, onward, type Place, plus, scaled, slerp, turned } from "./between";
import { LIVE_DELAY_MS, Playout } from "./playout";

/** A walker who is shown, and of when. */
export interface Shown extends Place {
  /** The moment that is shown, on the rig's clock; not later than what the rig told. */
  readonly t_ns: number;
  /** How long ago that was. */
  readonly age_ms: number;
  /** The pose that was told last before that moment: its doubt and motion model are shown. */
  readonly told: PoseMessage;
}

/** More than the longest delay needs. */
const KEPT = 64;
/** A step back in time, or one this long, is a seek, a loop or another rig; so is a jump this far (as on the console). */
const GAP_NS = 1e9;
const JUMP_M = 20;
/** A difference fades to a third in this time; a larger one than that is not worth a slide through walls. */
const FADE_MS = 80;
const SLIDE_M = 3;
const STILL: Place = { p_site_body_m: [0, 0, 0], wxyz_site_body: [1, 0, 0, 0] };

export class Poses {
  private told: PoseMessage[] = [];
  private playout: Playout;
  private last: { readonly place: Place; readonly t_ns: number; readonly now_ms: number } | null = null;
  /** What is shown less what was told, at `last`. */
  private rest = STILL;

  /** `speed` is how many of the walk's seconds pass in one of ours; poses are shown so late at most. */
  constructor(
    private readonly speed = 1,
    private readonly longest_ms = LIVE_DELAY_MS,
  ) {
    this.playout = new Playout(longest_ms);
  }

  /** The newest pose. */
  get newest(): PoseMessage | null {
    return this.told.at(-1) ?? null;
  }

  /** Take a pose that has come now; one that is older than what came before says nothing. */
  take(pose: PoseMessage, arrived_ms: number): void {
    const before = this.newest;
    if (before !== null) {
      if (pose.soughtJustBefore || isElsewhere(before, pose)) this.forget();
      else if (pose.t_ns <= before.t_ns) return;
    }
    this.told.push(pose);
    if (this.told.length > KEPT) this.told.shift();
    this.playout.take(this.ours_ms(pose.t_ns), arrived_ms);
    if (this.last !== null) this.rest = difference(this.last.place, this.placeAt(this.last.t_ns));
  }

  /** Return the walker as to be shown at `now_ms`; null before the first pose. */
  at(now_ms: number): Shown | null {
    const newest = this.newest;
    const moment_ms = this.playout.at(now_ms);
    if (newest === null || moment_ms === null) return null;
    const t_ns = moment_ms * this.speed * 1e6;
    const left = this.last === null ? 0 : Math.exp(-Math.max(0, now_ms - this.last.now_ms) / FADE_MS);
    this.rest = {
      p_site_body_m: scaled(this.rest.p_site_body_m, left),
      wxyz_site_body: slerp(STILL.wxyz_site_body, this.rest.wxyz_site_body, left),
    };
    const place = moved(this.placeAt(t_ns), this.rest);
    this.last = { place, t_ns, now_ms };
    const shown_ns = Math.min(t_ns, newest.t_ns);
    return {
      ...place,
      t_ns: shown_ns,
      age_ms: this.playout.age(this.ours_ms(shown_ns), now_ms),
      told: this.told.findLast((pose) => pose.t_ns <= t_ns) ?? newest,
    };
  }

  private ours_ms(t_ns: number): number {
    return t_ns / 1e6 / this.speed;
  }

  private placeAt(t_ns: number): Place {
    const after = this.told.findIndex((pose) => pose.t_ns > t_ns);
    const b = this.told[after];
    const a = this.told[after - 1];
    if (a && b) return between(a, b, t_ns);
    const end = b ?? this.told.at(-1);
    return end === undefined ? STILL : onward(end, t_ns);
  }

  private forget(): void {
    this.told = [];
    this.playout = new Playout(this.longest_ms);
    this.last = null;
    this.rest = STILL;
  }
}

function isElsewhere(before: PoseMessage, now: PoseMessage): boolean {
  return Math.abs(now.t_ns - before.t_ns) > GAP_NS || length(minus(now.p_site_body_m, before.p_site_body_m)) > JUMP_M;
}

/** Return what to add to `wanted` for `shown`; nothing where that is far. */
function difference(shown: Place, wanted: Place): Place {
  const way = minus(shown.p_site_body_m, wanted.p_site_body_m);
  const turn = turned(shown.wxyz_site_body, back(wanted.wxyz_site_body));
  const isFar = length(way) > SLIDE_M || angleBetween(turn, STILL.wxyz_site_body) > Math.PI / 2;
  return isFar ? STILL : { p_site_body_m: way, wxyz_site_body: turn };
}

function moved(place: Place, rest: Place): Place {
  return {
    p_site_body_m: plus(place.p_site_body_m, rest.p_site_body_m),
    wxyz_site_body: turned(rest.wxyz_site_body, place.wxyz_site_body),
  };
}
