/** The walks that can be joined or watched, as links that are kept up to date. DOM only. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import { clockText } from "../playback";
import type { Session } from "../protocol";
import type { Found } from "./directory";

/** Show the walks that are found. */
export function showWalks(found: Found): void {
  const note = element("walks-note", HTMLElement);
  if (found === "no server") {
    tell(note, say("live.no_server"));
    return;
  }
  element("enter", HTMLElement).hidden = found !== "hidden";
  const links = found === "hidden" ? [] : found.map(linkTo);
  const walks = element("walks", HTMLElement);
  // a list that has not changed stays, and so does the focus on one of its links
  if (links.map((link) => link.outerHTML).join("") !== walks.innerHTML) walks.replaceChildren(...links);
  tell(note, links.length > 0 ? null : say("live.none"));
}

function linkTo(session: Session): HTMLAnchorElement {
  const link = document.createElement("a");
  const isReplay = session.kind === "replay";
  const name = encodeURIComponent(session.name);
  link.href = isReplay ? `/replay/${name}` : `/ar?session=${name}`;
  const detail = document.createElement("span");
  detail.textContent = isReplay ? clockText(session.duration_s) : say("live.now");
  const what = isReplay
    ? say("live.replay", { name: session.title ?? session.log ?? session.name })
    : say("live.join", { name: session.title ?? session.name });
  link.append(what, detail);
  return link;
}
