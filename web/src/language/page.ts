/** The page in the visitor's language: when it is imported it fills what is marked `data-say`. DOM only. */

import { keep, kept } from "../memory";
import { chosenOf } from "./choice";
import { isKey, LANGUAGES, language, nameOf, say, speak } from "./speech";

const STORED = "agora.language";
/** What of an element is filled by which mark. */
const MARKS: readonly (readonly [string, (target: HTMLElement, text: string) => void])[] = [
  ["say", (target, text) => target.replaceChildren(text)],
  ["sayLabel", (target, text) => target.setAttribute("aria-label", text)],
  ["sayTitle", (target, text) => target.setAttribute("title", text)],
];

/** Fill everything below an element that is marked. */
export function fillMarked(root: ParentNode): void {
  for (const target of root.querySelectorAll<HTMLElement>("[data-say], [data-say-label], [data-say-title]"))
    for (const [mark, put] of MARKS) {
      const key = target.dataset[mark];
      // every key of our pages is free of values: a test holds it
      if (isKey(key)) put(target, (say as (key: string) => string)(key));
    }
}

/** Return the menu of languages, with its label. */
export function languageMenu(): HTMLElement {
  const label = document.createElement("label");
  const menu = document.createElement("select");
  menu.className = "language";
  menu.append(
    ...LANGUAGES.map((code) => {
      const option = new Option(nameOf(code), code, false, code === language());
      option.lang = code;
      return option;
    }),
  );
  menu.onchange = () => change(menu.value);
  label.append(say("language"), menu);
  return label;
}

/** Take another language: the page begins anew, since texts are everywhere in it. */
function change(code: string): void {
  keep(STORED, code);
  const url = new URL(location.href);
  url.searchParams.set("lang", code);
  location.replace(url);
}

const asked = new URLSearchParams(location.search).get("lang");
speak(chosenOf(LANGUAGES, asked, kept(STORED), navigator.languages));
document.documentElement.lang = language();
fillMarked(document);
