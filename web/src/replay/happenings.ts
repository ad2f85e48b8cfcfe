/** What happened on the walk, as a list to go by. DOM only. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import type { Happening, Timeline } from "./review";
import { happeningWords, spanWords } from "./told";

export class Happenings {
  private readonly list = element("happenings", HTMLElement);
  private readonly none = element("happenings-none", HTMLElement);
  private rows: readonly (readonly [Happening, HTMLButtonElement])[] = [];

  constructor(private readonly go: (position_s: number) => void) {}

  /** Show a walk's. */
  show({ happenings }: Timeline): void {
    this.rows = happenings.map((happening) => [happening, this.row(happening)]);
    this.list.replaceChildren(
      ...this.rows.map(([, button]) => {
        const item = document.createElement("li");
        item.append(button);
        return item;
      }),
    );
    tell(this.none, happenings.length === 0 ? say("replay.happenings.none") : null);
  }

  /** Show what happens at a place. */
  at(position_s: number): void {
    for (const [{ from_s, until_s }, button] of this.rows) {
      const isNow = from_s <= position_s && position_s <= until_s;
      if ((button.ariaCurrent === "true") !== isNow) button.ariaCurrent = String(isNow);
    }
  }

  private row(happening: Happening): HTMLButtonElement {
    const button = document.createElement("button");
    button.type = "button";
    button.dataset["kind"] = happening.kind;
    const when = document.createElement("span");
    when.textContent = spanWords(happening);
    button.append(happeningWords(happening), when);
    button.onclick = () => this.go(happening.from_s);
    return button;
  }
}
