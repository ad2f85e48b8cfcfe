/** What is for everyone on every page: its language and its theme, with their switches, and whether it is kept for later. Imported first by each page's script. */

import { tell } from "./dom";
import { languageMenu } from "./language/page";
import { say } from "./language/speech";
import { keep, kept } from "./memory";
import { keepForLater } from "./offline/keep";
import { themeOf } from "./theme";

const THEME = "agora.theme";
const contrast = matchMedia("(prefers-contrast: more)");

/** Show the theme, and return the switch of it. */
function themeSwitch(): HTMLElement {
  const label = document.createElement("label");
  const box = document.createElement("input");
  box.type = "checkbox";
  box.className = "glare";
  label.append(box, say("theme.glare"));
  let chosen = new URLSearchParams(location.search).get("theme");
  const show = (): void => {
    const theme = themeOf(chosen, kept(THEME), contrast.matches);
    box.checked = theme === "glare";
    document.documentElement.dataset["theme"] = theme;
  };
  box.onchange = () => {
    chosen = box.checked ? "glare" : "plain";
    keep(THEME, chosen);
    show();
  };
  contrast.onchange = show;
  show();
  return label;
}

/** Return a line that is empty until the page is kept on this device. */
function keptLine(): HTMLElement {
  const line = document.createElement("p");
  line.className = "kept";
  line.setAttribute("role", "status");
  line.hidden = true;
  window.addEventListener("load", () => {
    const { agora } = globalThis as { agora?: { readonly ready?: Promise<unknown> } };
    keepForLater(() => Promise.resolve(agora?.ready)).then(
      (isKept) => tell(line, isKept ? say("offline.kept") : null),
      (error: unknown) => console.warn("the pages are not kept for later", error),
    );
  });
  return line;
}

/** Let those who come by keys go past what stands first. */
function offerSkipping(): void {
  for (const link of document.querySelectorAll<HTMLAnchorElement>("a.skip"))
    link.onclick = () => {
      document.querySelector(link.hash)?.querySelector<HTMLElement>("button, input, select")?.focus();
      return false; // the start page's address tells a view
    };
}

offerSkipping();
const switches = [languageMenu(), themeSwitch(), keptLine()];
document.querySelector(".everyone")?.replaceChildren(...switches);
