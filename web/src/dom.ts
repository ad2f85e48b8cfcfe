/** Elements of the page by id. */

import { say } from "./language/speech";

/** Return the element of that id and kind; a page without it is a mistake of ours. */
export function element<T extends HTMLElement>(id: string, kind: new () => T): T {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${kind.name} #${id}`);
  return found;
}

/** Show a text in an element, or hide the element for null. */
export function tell(target: HTMLElement, text: string | null): void {
  target.hidden = text === null;
  if (text !== null && target.textContent !== text) target.textContent = text;
}

/** Whether this browser can draw; where it cannot, say so in the page. */
export function canDraw(notice: HTMLElement): boolean {
  if (document.createElement("canvas").getContext("webgl2")) return true;
  tell(notice, say("trouble.no_webgl"));
  return false;
}

/** Put `globalThis.agora` in place on a page that draws no pictures of a walk; `stats` tells what it draws instead, if anything. */
export function publishNothing(ready: Promise<void> = Promise.resolve(), stats: () => unknown = () => null): void {
  const api = { ready, stats, project: () => null, pose: () => null };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}
