/** What the head-mounted display's menu can do. DOM only. */

import type { Choices } from "./choices";
import { element } from "./dom";
import type { Deed } from "./hmd";
import type { Request } from "./playback";
import type { Session } from "./protocol";

const CARE: Deed = { words: () => "I will take care", do: () => element("careful", HTMLButtonElement).click() };

/** Return what can be done now; before the notice of a live walk is confirmed, only that. */
export function deedsOf(choices: Choices, session: Session | null, ask: (request: Request) => void): readonly Deed[] {
  if (!element("care", HTMLElement).hidden) return [CARE];
  const playing = session?.playback?.playing ?? null;
  const play = { words: () => (playing ? "Pause" : "Play"), do: () => ask(playing ? PAUSE : PLAY) };
  return [
    { words: () => (choices.isPast ? "Today" : "AD 150"), do: () => choices.toggle() },
    { words: () => "Sun", do: () => `The sun ${choices.nextSun()}` },
    { words: () => "How sure", do: () => choices.toggleEvidence() },
    ...(playing === null ? [] : [play]),
    { words: () => "Leave", do: leave },
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
