/** Which key does what on a replay's page. Pure. */

import { clampSeek, neighbourSpeed, type Request } from "../playback";
import type { Playback } from "../protocol";

/** What the page is asked to do: something of the rig, or of itself. */
export type Deed = Request | { readonly action: "help" } | { readonly action: "step"; readonly direction: 1 | -1 };

export const STEP_S = 5;
export const LONG_STEP_S = 15;
/** A place this near is the same. */
const SAME_S = 0.001;

/** Return what a key asks for at this place of the walk; null for nothing. */
export function deedOfKey(key: string, shift: boolean, playback: Playback, duration_s: number): Deed | null {
  const { position_s, speed } = playback;
  const jump = (by_s: number): Deed => ({ action: "seek", value: clampSeek(position_s + by_s, duration_s) });
  switch (key) {
    case " ":
    case "k":
      return { action: playback.playing ? "pause" : "play", value: null };
    case "ArrowLeft":
      return jump(shift ? -LONG_STEP_S : -STEP_S);
    case "ArrowRight":
      return jump(shift ? LONG_STEP_S : STEP_S);
    case ",":
      return { action: "step", direction: -1 };
    case ".":
      return { action: "step", direction: 1 };
    case "[":
    case "ArrowDown":
      return { action: "speed", value: neighbourSpeed(speed, -1) };
    case "]":
    case "ArrowUp":
      return { action: "speed", value: neighbourSpeed(speed, 1) };
    case "l":
    case "L":
      return { action: "loop", value: !playback.looping };
    case "Home":
      return { action: "seek", value: 0 };
    case "End":
      return { action: "seek", value: duration_s };
    case "?":
      return { action: "help" };
    default:
      return null;
  }
}

/** Return when the picture before the one that is shown at a place arrived; null where there is none. */
export function pictureBefore(pictures_s: readonly number[], position_s: number): number | null {
  const shown = indexAt(pictures_s, position_s);
  return shown > 0 ? (pictures_s[shown - 1] ?? null) : null;
}

/** Return when the picture after the one that is shown at a place arrived; null where there is none. */
export function pictureAfter(pictures_s: readonly number[], position_s: number): number | null {
  return pictures_s[indexAt(pictures_s, position_s) + 1] ?? null;
}

/** Return the index of the newest picture at a place, -1 before the first. */
export function indexAt(pictures_s: readonly number[], position_s: number): number {
  let [low, high] = [0, pictures_s.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((pictures_s[middle] ?? 0) <= position_s + SAME_S) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}
