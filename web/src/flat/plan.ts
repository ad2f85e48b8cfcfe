/** The plan of the site that stands in the model's place: outlines numbered as the list beside it, north up, with a scale. SVG only. */

import { say, sayLength } from "../language/speech";
import { frameOf, outlinePath, type Place } from "../plan";
import type { Monument } from "../site";

const SVG = "http://www.w3.org/2000/svg";
/** How long the bar of the scale is. */
const BAR_M = 50;
/** Height of a number, metres of the plan. */
const NUMBER_M = 7;

export class FlatPlan {
  readonly figure = document.createElement("figure");
  private readonly shapes: readonly (SVGElement | null)[];

  /** `pick` is told which monument of the list was pointed at. */
  constructor(monuments: readonly Monument[], pick: (index: number) => void) {
    const frame = frameOf(monuments.map(({ footprint }) => footprint));
    const svg = make("svg", "map");
    svg.setAttribute(
      "viewBox",
      `${frame.west} ${-frame.north} ${frame.east - frame.west} ${frame.north - frame.south + 10}`,
    );
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", say("flat.plan"));
    this.shapes = monuments.map(({ footprint, name }, index) => {
      if (footprint.length < 3) return null;
      const shape = make("path", "outline");
      shape.setAttribute("d", outlinePath(footprint));
      const title = make("title", "");
      title.textContent = name;
      shape.append(title);
      shape.addEventListener("click", () => pick(index));
      return shape;
    });
    // the largest lie below
    const bySize = this.shapes
      .map((shape, index) => ({ shape, index, area: spanOf(monuments[index]?.footprint ?? []) }))
      .sort((a, b) => b.area - a.area);
    for (const { shape } of bySize) if (shape) svg.append(shape);
    for (const { index, shape } of bySize)
      if (shape) svg.append(numberAt(middleOf(monuments[index]?.footprint ?? []), index + 1));
    svg.append(scale(frame.west + 4, -frame.south + 4));
    this.figure.append(svg);
    const words = document.createElement("figcaption");
    words.textContent = say("flat.scale", { length: sayLength(BAR_M, "meter") });
    this.figure.append(words);
  }

  /** Show that a monument of the list is being read, or no longer. */
  mark(index: number, isRead: boolean): void {
    this.shapes[index]?.classList.toggle("read", isRead);
  }
}

function numberAt([e, n]: Place, number: number): SVGElement {
  const text = make("text", "number");
  text.setAttribute("x", e.toFixed(1));
  text.setAttribute("y", (-n + NUMBER_M * 0.36).toFixed(1));
  text.setAttribute("font-size", String(NUMBER_M));
  text.textContent = String(number);
  return text;
}

function scale(x: number, y: number): SVGElement {
  const bar = make("path", "scale");
  bar.setAttribute("d", `M${x},${y - 2}v2h${BAR_M}v-2`);
  return bar;
}

function middleOf(outline: readonly Place[]): Place {
  const sum = outline.reduce(([e, n], [e1, n1]) => [e + e1, n + n1] as const, [0, 0] as Place);
  return [sum[0] / outline.length, sum[1] / outline.length];
}

function spanOf(outline: readonly Place[]): number {
  const [east, north] = [outline.map(([e]) => e), outline.map(([, n]) => n)];
  return (Math.max(...east) - Math.min(...east)) * (Math.max(...north) - Math.min(...north));
}

function make(name: string, kind: string): SVGElement {
  const made = document.createElementNS(SVG, name);
  if (kind !== "") made.setAttribute("class", kind);
  return made;
}
