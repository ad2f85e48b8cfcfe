/** The monuments in a list that can be searched, and on a plan of the site. DOM only. */

import { element, tell } from "../dom";
import { language, say, sayLength } from "../language/speech";
import { SiteMap } from "../map";
import { contains, type Place } from "../plan";
import type { Monument, Site } from "../site";
import type { Eye } from "./eye";
import { found } from "./finding";

/** Half of the field of view that the plan shows. */
const HALF_RAD = 0.55;

export class Places {
  private readonly list = element("places-list", HTMLElement);
  private readonly search = element("places-find", HTMLInputElement);
  private readonly map: SiteMap | null;
  private eye: Eye | null = null;

  /** `choose` is told of a monument of the list, `pick` of a place of the plan. */
  constructor(
    private readonly site: Site,
    private readonly choose: (monument: Monument) => void,
    pick: (place: Place) => void,
  ) {
    const outlined = site.monuments.filter(({ footprint }) => footprint.length > 2);
    const plan = element("plan", HTMLElement);
    plan.hidden = outlined.length === 0;
    this.map =
      outlined.length === 0
        ? null
        : new SiteMap(
            plan,
            outlined.map(({ footprint }) => footprint),
            pick,
          );
    this.search.placeholder = say("places.find");
    this.search.oninput = () => this.fill();
    this.search.onkeydown = (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault(); // the focus goes elsewhere, and the key would press what it goes to
      this.list.querySelector("button")?.click();
    };
    this.fill();
  }

  /** The middle of the site. */
  get middle(): Place {
    return this.map?.middle ?? [0, 0];
  }

  /** Show on the plan where the visitor is. */
  show(eye: Eye): void {
    this.eye = eye;
    this.map?.show([eye.place_site_m[0], eye.place_site_m[1]], eye.heading_rad, HALF_RAD, null);
  }

  /** Tell how far away everything is now, and wait for words; on a touch screen that would bring its keyboard up. */
  open(): void {
    this.fill();
    if (matchMedia("(pointer: fine)").matches) this.search.focus();
  }

  private fill(): void {
    const monuments = found(this.site.monuments, this.search.value, language());
    this.list.replaceChildren(
      ...monuments.map((monument) => {
        const row = document.createElement("li");
        const button = document.createElement("button");
        button.type = "button";
        const far = document.createElement("span");
        far.className = "quiet";
        far.textContent = sayLength(Math.round(this.distance_m(monument)), "meter");
        button.append(monument.name, far);
        button.onclick = () => this.choose(monument);
        row.append(button);
        return row;
      }),
    );
    tell(element("places-none", HTMLElement), monuments.length === 0 ? say("places.none") : null);
  }

  private distance_m({ footprint }: Monument): number {
    const { eye } = this;
    if (!eye || contains(footprint, [eye.place_site_m[0], eye.place_site_m[1]])) return 0;
    return Math.min(...footprint.map(([e, n]) => Math.hypot(e - eye.place_site_m[0], n - eye.place_site_m[1])));
  }
}
