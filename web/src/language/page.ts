/** The page in the visitor's language: imported first by every page, it fills what is marked `data-say`. DOM only. */

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

/** Offer the languages in every `<select class="language">`. */
function offer(): void {
  for (const menu of document.querySelectorAll<HTMLSelectElement>("select.language")) {
    menu.replaceChildren(
      ...LANGUAGES.map((code) => {
        const option = new Option(nameOf(code), code, false, code === language());
        option.lang = code;
        return option;
      }),
    );
    menu.setAttribute("aria-label", say("language"));
    menu.onchange = () => change(menu.value);
  }
}

/** Take another language: the page begins anew, since texts are everywhere in it. */
function change(code: string): void {
  try {
    localStorage.setItem(STORED, code);
  } catch {
    // a browser that keeps nothing is told by the address
  }
  const url = new URL(location.href);
  url.searchParams.set("lang", code);
  location.replace(url);
}

function stored(): string | null {
  try {
    return localStorage.getItem(STORED);
  } catch {
    return null;
  }
}

const asked = new URLSearchParams(location.search).get("lang");
speak(chosenOf(LANGUAGES, asked, stored(), navigator.languages));
document.documentElement.lang = language();
fillMarked(document);
offer();
