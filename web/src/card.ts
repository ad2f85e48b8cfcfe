/** What is told of a monument that was picked: its name, caption, how it is known, and rival reconstructions to choose from. */

import { element, tell } from "./dom";
import { EVIDENCE_WORDS, parseEvidence } from "./evidence";
import { say } from "./language/speech";
import type { Square } from "./model";
import type { Monument, Site } from "./site";
import type { Thing } from "./thing";

export class Card {
  private readonly panel = element("card", HTMLElement);
  private readonly menu = element("variant", HTMLSelectElement);
  private shown: Monument | null = null;

  constructor(
    private readonly site: Site,
    private readonly square: () => Square | null,
    choose: (monument: string, variant: string) => void,
  ) {
    element("card-close", HTMLButtonElement).onclick = () => this.show(null, null);
    this.menu.onchange = () => {
      if (!this.shown) return;
      choose(this.shown.id, this.menu.value);
      this.argue(this.shown);
    };
  }

  /** Tell of a monument, and of the part of it that was picked; null puts the card away. */
  show(monument: Monument | null, part: Thing | null): void {
    this.shown = monument;
    this.panel.hidden = monument === null;
    if (monument === null) return;
    element("card-name", HTMLElement).textContent = monument.name;
    tell(element("card-caption", HTMLElement), monument.caption);
    const evidence = part?.evidence ?? parseEvidence(monument.evidence);
    const words = element("card-evidence", HTMLElement);
    words.dataset["evidence"] = evidence ?? "";
    const meaning = evidence === null ? null : (this.site.evidence[evidence] ?? say(EVIDENCE_WORDS[evidence]));
    tell(words, meaning === null ? null : partWords(part, meaning));
    const keys = part?.source?.split(", ").map((key) => this.site.sources[key] ?? key);
    const sources = (keys ?? monument.sources).join("; ");
    tell(element("card-source", HTMLElement), sources === "" ? null : say("card.source", { sources }));
    tell(element("card-review", HTMLElement), monument.isReviewed ? null : say("card.unreviewed"));
    this.offer(monument);
  }

  private offer(monument: Monument): void {
    const { variants } = monument;
    const now = this.square()?.variantOf(monument.id) ?? null;
    element("variants", HTMLElement).hidden = variants.length < 2 || now === null;
    this.menu.replaceChildren(...variants.map(({ id, name }) => new Option(name, id, false, id === now)));
    this.argue(monument);
  }

  /** Say what speaks for the reconstruction that is shown. */
  private argue({ variants }: Monument): void {
    tell(element("card-why", HTMLElement), variants.find(({ id }) => id === this.menu.value)?.why ?? null);
  }
}

/** Return "The roof: Hypothetical …" for `basilica_stoa/roof`; the meaning alone for a monument as a whole. */
function partWords(part: Thing | null, meaning: string): string {
  const name = part?.name.split("/")[1]?.replace(/_/g, " ");
  return name === undefined ? meaning : say("card.part", { part: name, meaning });
}
