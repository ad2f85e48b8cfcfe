/** The notice at the start of a live walk: who looks at the past still walks in the present. Confirmed once on each device. */

import { element } from "./dom";
import { keep, kept } from "./memory";
import type { Session } from "./protocol";

const CONFIRMED = "agora.care";

export class Care {
  private readonly panel = element("care", HTMLElement);
  private confirmed = kept(CONFIRMED) === "yes";

  constructor() {
    element("careful", HTMLButtonElement).onclick = () => {
      this.confirmed = true;
      this.panel.hidden = true;
      keep(CONFIRMED, "yes");
    };
  }

  /** Ask whoever walks; who watches a recording at a desk falls over nothing. */
  show({ kind }: Session): void {
    const asks = kind === "live" && !this.confirmed;
    if (asks === !this.panel.hidden) return;
    this.panel.hidden = !asks;
    if (asks) element("careful", HTMLButtonElement).focus();
  }
}
