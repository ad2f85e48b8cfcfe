/** The walks that can be joined or watched, as links that are kept up to date. DOM only. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import { clockText } from "../playback";
import { parseSessions, type Session } from "../protocol";

const LOOK_AGAIN_MS = 3000;

/** Show the walks, and go on looking for new ones. */
export async function showWalks(): Promise<void> {
  const note = element("walks-note", HTMLElement);
  try {
    const answer = await fetch("/api/sessions");
    element("enter", HTMLElement).hidden = answer.status !== 401;
    const links = answer.status === 401 ? [] : parseSessions(await answer.json()).map(linkTo);
    const walks = element("walks", HTMLElement);
    // a list that has not changed stays, and so does the focus on one of its links
    if (links.map((link) => link.outerHTML).join("") !== walks.innerHTML) walks.replaceChildren(...links);
    tell(note, links.length > 0 ? null : say("live.none"));
  } catch {
    tell(note, say("live.no_server"));
  }
  window.setTimeout(() => void showWalks(), LOOK_AGAIN_MS);
}

function linkTo(session: Session): HTMLAnchorElement {
  const link = document.createElement("a");
  const isReplay = session.kind === "replay";
  const name = encodeURIComponent(session.name);
  link.href = isReplay ? `/replay/${name}` : `/ar?session=${name}`;
  const detail = document.createElement("span");
  detail.textContent = isReplay ? clockText(session.duration_s) : say("live.now");
  const what = isReplay
    ? say("live.replay", { name: session.log ?? session.name })
    : say("live.join", { name: session.name });
  link.append(what, detail);
  return link;
}
