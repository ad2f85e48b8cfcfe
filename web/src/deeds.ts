/** What the head-mounted display's menu can do. DOM only. */

import type { Choices } from "./choices";
import { element } from "./dom";
import type { Deed } from "./hmd";
import { say } from "./language/speech";
import type { Request } from "./playback";
import type { Session } from "./protocol";

const CARE: Deed = { words: () => say("care.confirm"), do: () => element("careful", HTMLButtonElement).click() };

/** Return what can be done now; before the notice of a live walk is confirmed, only that. */
export function deedsOf(choices: Choices, session: Session | null, ask: (request: Request) => void): readonly Deed[] {
  if (!element("care", HTMLElement).hidden) return [CARE];
  const playing = session?.playback?.playing ?? null;
  const play = { words: () => say(playing ? "bar.pause" : "bar.play"), do: () => ask(playing ? PAUSE : PLAY) };
  return [
    { words: () => say(choices.isPast ? "time.today" : "time.ancient"), do: () => choices.toggle() },
    { words: () => say("deed.sun"), do: () => say("sun.said", { when: choices.nextSun() }) },
    { words: () => say("deed.evidence"), do: () => choices.toggleEvidence() },
    ...(playing === null ? [] : [play]),
    { words: () => say("deed.leave"), do: leave },
  ];
}

const PLAY: Request = { action: "play", value: null };
const PAUSE: Request = { action: "pause", value: null };

/** Go on in the ordinary page, at the same walk. */
function leave(): void {
  const url = new URL(location.href);
  for (const name of ["display", "eyes", "ipd"]) url.searchParams.delete(name);
  location.assign(url);
}
