/** The notice at the start of a live walk: who looks at the past still walks in the present. Confirmed once on each device. */

import { element } from "./dom";
import type { Session } from "./protocol";

const CONFIRMED = "agora.care";

export class Care {
  private readonly panel = element("care", HTMLElement);
  private confirmed = remembered();

  constructor() {
    element("careful", HTMLButtonElement).onclick = () => {
      this.confirmed = true;
      this.panel.hidden = true;
      try {
        localStorage.setItem(CONFIRMED, "yes");
      } catch {
        // a browser that keeps nothing asks again next time
      }
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

function remembered(): boolean {
  try {
    return localStorage.getItem(CONFIRMED) === "yes";
  } catch {
    return false;
  }
}
