/** What a pointer does on the picture: it names the monument under it; a click or a tap tells of it, or measures. DOM only. */

import { element, tell } from "../dom";
import type { Monument, Site } from "../site";
import type { Thing } from "../thing";
import type { Stage } from "./stage";
import type { Tape } from "./tape";

/** What moves further than this is a drag, pixels. */
const STEADY_PX = 6;

export class Pointer {
  private readonly byId: ReadonlyMap<string, Monument>;
  private readonly label = element("label", HTMLElement);
  private busy = false;

  constructor(
    private readonly stage: Stage,
    site: Site,
    private readonly tape: Tape,
    private readonly tellOf: (monument: Monument | null, part: Thing | null) => void,
  ) {
    this.byId = new Map(site.monuments.map((monument) => [monument.id, monument]));
    const { canvas } = stage;
    let from: readonly [number, number] = [0, 0];
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons === 0 && event.pointerType === "mouse") this.nameAt(event);
      else tell(this.label, null);
    });
    canvas.addEventListener("pointerdown", ({ clientX, clientY }) => {
      from = [clientX, clientY];
    });
    canvas.addEventListener("click", (event) => {
      if (Math.hypot(event.clientX - from[0], event.clientY - from[1]) <= STEADY_PX) this.click(event);
    });
    canvas.addEventListener("pointerleave", () => tell(this.label, null));
  }

  private click(event: MouseEvent): void {
    if (this.tape.isOn) {
      const place = this.stage.placeAt(event);
      if (place) this.tape.click(place);
      return;
    }
    const thing = this.stage.at(event);
    this.tellOf(this.byId.get(thing?.group ?? "") ?? null, thing);
  }

  /** At most once a picture: to look through the model takes a while. */
  private nameAt({ clientX, clientY }: MouseEvent): void {
    if (this.busy) return;
    this.busy = true;
    requestAnimationFrame(() => {
      this.busy = false;
      const thing = this.tape.isOn ? null : this.stage.at({ clientX, clientY });
      tell(this.label, this.byId.get(thing?.group ?? "")?.name ?? null);
      this.label.style.left = `${clientX}px`;
      this.label.style.top = `${clientY}px`;
    });
  }
}
