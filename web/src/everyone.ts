/** What is for everyone on every page: its language and its theme, with their switches. Imported first by each page's script. */

import { languageMenu } from "./language/page";
import { say } from "./language/speech";
import { keep, kept } from "./memory";
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

const switches = [languageMenu(), themeSwitch()];
document.querySelector(".everyone")?.replaceChildren(...switches);
