/** The site's plan on the page: outlines, the visitor's place with its doubt, and where the picture looks. DOM only. */

import type { Doubt } from "./certainty";
import { say } from "./language/speech";
import { conePath, type Frame, frameOf, middleOf, outlinePath, type Place, within } from "./plan";

const SVG = "http://www.w3.org/2000/svg";
/** A doubt larger than this is drawn no larger: it would cover the plan. */
const LARGEST_DOUBT_M = 60;
/** So many presses of an arrow key go from one side of the plan to the other. */
const STEPS = 40;
const WAYS: Readonly<Record<string, Place>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** Called with a place that is tapped, how many metres a pixel of the page is, and with what it was tapped. */
export type Chosen = (place: Place, metresPerPixel: number, pointerType: string) => void;

export class SiteMap {
  readonly frame: Frame;
  private readonly svg: SVGSVGElement;
  private visitor: Place | null = null;
  private readonly cone = make("path", "cone");
  private readonly doubt = make("circle", "doubt");
  private readonly dot = make("circle", "dot");

  /** Put the plan of these outlines into an element. */
  constructor(parent: HTMLElement, outlines: readonly (readonly Place[])[], chosen?: Chosen) {
    this.frame = frameOf(outlines);
    this.svg = make("svg", "map") as SVGSVGElement;
    this.look(this.frame);
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", say("plan.label"));
    for (const outline of outlines) {
      const path = make("path", "outline");
      path.setAttribute("d", outlinePath(outline));
      this.svg.append(path);
    }
    this.dot.setAttribute("r", "2.4");
    this.svg.append(this.doubt, this.cone, this.dot);
    parent.replaceChildren(this.svg);
    if (!chosen) return;
    this.svg.addEventListener("click", ({ clientX, clientY, pointerType }: PointerEvent) => {
      const [place, beside] = [this.placeAt(clientX, clientY), this.placeAt(clientX + 1, clientY)];
      chosen(place, Math.hypot(beside[0] - place[0], beside[1] - place[1]), pointerType);
    });
    this.offerKeys(chosen);
  }

  /** Let the arrow keys move a cross over the plan, and Enter choose. */
  private offerKeys(chosen: Chosen): void {
    const cross = make("path", "cross");
    let at: Place | null = null;
    this.svg.tabIndex = 0;
    this.svg.setAttribute("role", "application");
    this.svg.setAttribute("aria-label", say("plan.keys"));
    this.svg.addEventListener("keydown", (event) => {
      const { width } = this.svg.viewBox.baseVal;
      const way = WAYS[event.key];
      const [e, n] = at ?? this.visitor ?? this.middle;
      if (way) at = within([e + (way[0] * width) / STEPS, n + (way[1] * width) / STEPS], this.frame);
      else if (event.key === "Enter" && at !== null) chosen(at, width / Math.max(1, this.svg.clientWidth), "mouse");
      else return;
      event.preventDefault();
      event.stopPropagation();
      if (at === null) return;
      const arm = width / STEPS;
      cross.setAttribute("d", `M${at[0] - arm},${-at[1]}h${2 * arm}M${at[0]},${-at[1] - arm}v${2 * arm}`);
      this.svg.append(cross);
    });
    this.svg.addEventListener("blur", () => cross.remove());
  }

  /** Whether a place is on the plan. */
  holds(place: Place): boolean {
    const [e, n] = within(place, this.frame);
    return e === place[0] && n === place[1];
  }

  /** Show only what lies about a place, to that many metres on each side. */
  zoom([e, n]: Place, half_m: number): void {
    this.look({ west: e - half_m, south: n - half_m, east: e + half_m, north: n + half_m });
  }

  private look({ west, south, east, north }: Frame): void {
    this.svg.setAttribute("viewBox", `${west} ${-north} ${east - west} ${north - south}`);
  }

  /** Where the site's middle is. */
  get middle(): Place {
    return middleOf(this.frame);
  }

  /** Show the visitor; the heading is null where it is not known. */
  show(place: Place | null, heading_rad: number | null, half_rad: number, doubt: Doubt | null): void {
    this.visitor = place;
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
