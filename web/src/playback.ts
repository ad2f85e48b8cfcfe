/**
 * Playing a recorded walk: what the bar shows, which keys do what, and how long ago a picture's pose was true.
 *
 * Pure: time is passed in (milliseconds of `performance.now()`), requests are returned, nothing is sent.
 */

import type { Playback, Session } from "./protocol";

export type Action = "play" | "pause" | "seek" | "speed" | "loop" | "estimator";

export interface Request {
  readonly action: Action;
  readonly value: number | string | boolean | null;
}

export const SPEEDS: readonly number[] = [0.25, 0.5, 1, 2, 4];
const STEP_S = 5;
const LONG_STEP_S = 15;

/** Return what a key asks for in the present state, or null. Space: play and pause; arrows: seek and speed. */
export function requestOfKey(key: string, shift: boolean, playback: Playback, duration_s: number): Request | null {
  const step_s = shift ? LONG_STEP_S : STEP_S;
  switch (key) {
    case " ":
      return { action: playback.playing ? "pause" : "play", value: null };
    case "ArrowLeft":
      return { action: "seek", value: clampSeek(playback.position_s - step_s, duration_s) };
    case "ArrowRight":
      return { action: "seek", value: clampSeek(playback.position_s + step_s, duration_s) };
    case "Home":
      return { action: "seek", value: 0 };
    case "ArrowUp":
      return { action: "speed", value: neighbourSpeed(playback.speed, 1) };
    case "ArrowDown":
      return { action: "speed", value: neighbourSpeed(playback.speed, -1) };
    default:
      return null;
  }
}

/** Return a position that exists in the log. */
export function clampSeek(position_s: number, duration_s: number): number {
  return Math.min(Math.max(position_s, 0), Math.max(0, duration_s));
}

/** Return the next faster (+1) or slower (-1) speed on offer. */
export function neighbourSpeed(speed: number, direction: 1 | -1): number {
  const nearest = SPEEDS.reduce((best, entry) => (Math.abs(entry - speed) < Math.abs(best - speed) ? entry : best), 1);
  const index = SPEEDS.indexOf(nearest) + direction;
  return SPEEDS[Math.min(Math.max(index, 0), SPEEDS.length - 1)] ?? 1;
}

/** Return seconds as `1:07`. */
export function clockText(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

export interface EstimatorChoice {
  readonly name: string;
  /** Why it cannot run on this log; null where it can. */
  readonly reason: string | null;
}

/** Return every estimator of the session, those that it cannot run included, in the server's order. */
export function estimatorChoices(session: Session): readonly EstimatorChoice[] {
  const names = [...session.estimators, ...Object.keys(session.unavailable)];
  if (session.estimator !== "") names.unshift(session.estimator);
  const listed = [...session.estimators, ...names].filter((name, i, all) => all.indexOf(name) === i);
  return listed.map((name) => ({ name, reason: session.unavailable[name] ?? null }));
}

/** No message is under way for so long: the rig's clock was set back. */
const JUMP_MS = 60_000;

/**
 * How old the pose on the screen is.
 *
 * The rig's clock and this browser's share no zero, so the fastest message seen sets it: an age counts from there, and
 * holds the time since arrival and whatever a message was slower than the fastest one.
 */
export class PoseAge {
  private fastest_ms = Number.POSITIVE_INFINITY;
  private born_ms: number | null = null;

  /** Take note of the message whose picture is being drawn: sent on the rig's clock, arrived on ours. */
  drawn(t_sent_ns: number, arrived_ms: number): void {
    const transit_ms = arrived_ms - t_sent_ns / 1e6;
    if (transit_ms - this.fastest_ms > JUMP_MS) this.fastest_ms = Number.POSITIVE_INFINITY;
    this.fastest_ms = Math.min(this.fastest_ms, transit_ms);
    const late_ms = transit_ms - this.fastest_ms;
    this.born_ms = arrived_ms - late_ms;
  }

  /** Start afresh: another rig, another clock. */
  reset(): void {
    this.fastest_ms = Number.POSITIVE_INFINITY;
    this.born_ms = null;
  }

  /** Return the age at `now_ms`, or null before the first pose. */
  at(now_ms: number): number | null {
    return this.born_ms === null ? null : Math.max(0, now_ms - this.born_ms);
  }
}

/** Pictures a second, counted over the last two seconds. */
export class FrameRate {
  private readonly times_ms: number[] = [];

  /** Count one drawn picture. */
  count(now_ms: number): void {
    this.times_ms.push(now_ms);
    while ((this.times_ms[0] ?? now_ms) < now_ms - 2000) this.times_ms.shift();
  }

  /** Return the rate at `now_ms`: 0 when nothing was drawn for two seconds. */
  at(now_ms: number): number {
    const recent = this.times_ms.filter((time) => time >= now_ms - 2000);
    const [first] = recent;
    if (first === undefined || recent.length < 2) return 0;
    return ((recent.length - 1) * 1000) / Math.max(1, now_ms - first);
  }
}
