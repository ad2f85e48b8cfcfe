/** The site's plan on the page: outlines, the visitor's place with its doubt, and where the picture looks. DOM only. */

import type { Doubt } from "./certainty";
import { conePath, type Frame, frameOf, middleOf, outlinePath, type Place, within } from "./plan";

const SVG = "http://www.w3.org/2000/svg";
/** A doubt larger than this is drawn no larger: it would cover the plan. */
const LARGEST_DOUBT_M = 60;

export class SiteMap {
  readonly frame: Frame;
  private readonly svg: SVGSVGElement;
  private readonly cone = make("path", "cone");
  private readonly doubt = make("circle", "doubt");
  private readonly dot = make("circle", "dot");

  /** Put the plan of these outlines into an element. `chosen` is called with a place that is tapped. */
  constructor(parent: HTMLElement, outlines: readonly (readonly Place[])[], chosen?: (place: Place) => void) {
    this.frame = frameOf(outlines);
    this.svg = make("svg", "map") as SVGSVGElement;
    const { west, south, east, north } = this.frame;
    this.svg.setAttribute("viewBox", `${west} ${-north} ${east - west} ${north - south}`);
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", "Plan of the site, north up, with your place");
    for (const outline of outlines) {
      const path = make("path", "outline");
      path.setAttribute("d", outlinePath(outline));
      this.svg.append(path);
    }
    this.dot.setAttribute("r", "2.4");
    this.svg.append(this.doubt, this.cone, this.dot);
    parent.replaceChildren(this.svg);
    if (chosen) this.svg.addEventListener("click", (event) => chosen(this.placeAt(event.clientX, event.clientY)));
  }

  /** Where the site's middle is. */
  get middle(): Place {
    return middleOf(this.frame);
  }

  /** Show the visitor; the heading is null where it is not known. */
  show(place: Place | null, heading_rad: number | null, half_rad: number, doubt: Doubt | null): void {
    const hidden = place === null;
    for (const part of [this.cone, this.doubt, this.dot]) part.toggleAttribute("hidden", hidden);
    if (place === null) return;
    const [e, n] = within(place, this.frame);
    for (const part of [this.doubt, this.dot]) {
      part.setAttribute("cx", e.toFixed(1));
      part.setAttribute("cy", (-n).toFixed(1));
    }
    this.doubt.setAttribute("r", Math.min(doubt?.place_m ?? 0, LARGEST_DOUBT_M).toFixed(1));
    const known = heading_rad !== null;
    this.cone.toggleAttribute("hidden", !known);
    if (known) this.cone.setAttribute("d", conePath([e, n], heading_rad, half_rad + (doubt?.heading_rad ?? 0)));
  }

  /** Return the place that is drawn at a point of the window. */
  placeAt(x: number, y: number): Place {
    const matrix = this.svg.getScreenCTM()?.inverse();
    const { x: e, y: s } = new DOMPoint(x, y).matrixTransform(matrix);
    return [e, -s];
  }

  /** Return the point of the window where a place is drawn. */
  pointOf([e, n]: Place): readonly [number, number] {
    const { x, y } = new DOMPoint(e, -n).matrixTransform(this.svg.getScreenCTM() ?? undefined);
    return [x, y];
  }
}

function make(name: string, kind: string): SVGElement {
  const made = document.createElementNS(SVG, name);
  made.setAttribute("class", kind);
  return made;
}
