/** Curves of estimators over the walk, tied to the place in time: pointing tells values, a click goes there. uPlot and DOM. */

import uPlot from "uplot";
import { say } from "../language/speech";
import { clockText } from "../playback";
import { type Chosen, CURVES, type CurveName, type Table, tableOf } from "./curves";
import { figureText } from "./told";

const HEIGHT_PX = 116;
/** Values nearer to each other are drawn as the same. */
const FLAT = 1e-6;
const SYNC = "agora-replay";

interface Drawn {
  readonly plot: uPlot;
  readonly line: HTMLElement;
}

export class Charts {
  private drawn: Drawn[] = [];
  private position_s = 0;
  private chosen: readonly Chosen[] = [];
  private width = 0;

  constructor(
    private readonly root: HTMLElement,
    private readonly go: (position_s: number) => void,
  ) {
    new ResizeObserver(() => this.fit()).observe(root);
    // another theme has other colours
    new MutationObserver(() => this.show(this.chosen)).observe(document.documentElement, {
      attributeFilter: ["data-theme"],
    });
  }

  /** Draw these courses. */
  show(chosen: readonly Chosen[]): void {
    this.chosen = chosen;
    for (const { plot } of this.drawn) plot.destroy();
    this.width = this.root.clientWidth;
    this.root.replaceChildren(...(chosen.length === 0 ? [note(say("replay.curves.none"))] : []));
    this.drawn = this.width === 0 ? [] : CURVES.flatMap((name) => this.chart(name) ?? []);
    this.at(this.position_s);
  }

  /** Show the place in time. */
  at(position_s: number): void {
    this.position_s = position_s;
    for (const { plot, line } of this.drawn) {
      const x = plot.valToPos(position_s, "x");
      line.hidden = !(x >= 0 && x <= plot.over.clientWidth);
      line.style.transform = `translateX(${x}px)`;
    }
  }

  private chart(name: CurveName): Drawn | null {
    const table = tableOf(name, this.chosen);
    if (table === null) return null;
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    const values = document.createElement("output");
    const title = document.createElement("span");
    title.textContent = say(`replay.curve.${name}`);
    caption.append(title, values);
    figure.append(caption);
    this.root.append(figure);
    const style = getComputedStyle(this.root);
    const ink = style.getPropertyValue("--quiet").trim();
    const grid = { stroke: style.getPropertyValue("--grid").trim(), width: 1 };
    const axis = { stroke: ink, grid, ticks: { show: false }, font: "12px system-ui, sans-serif" };
    const plot = new uPlot(
      {
        width: this.width,
        height: HEIGHT_PX,
        legend: { show: false },
        cursor: { sync: { key: SYNC, setSeries: false }, drag: { x: false, y: false }, y: false },
        scales: { x: { time: false }, y: { range: spanOf } },
        axes: [
          { ...axis, size: 22, gap: 2, space: 64, values: (_plot, ticks) => ticks.map(clockText) },
          { ...axis, size: 42, gap: 4, space: 26 },
        ],
        series: [
          {},
          ...table.colours.map((colour) => ({
            stroke: style.getPropertyValue(`--curve-${colour}`).trim(),
            width: 1.5,
            points: { show: false },
          })),
        ],
        hooks: { setCursor: [(plot) => tellValues(plot, values, table)] },
      },
      table.data as uPlot.AlignedData,
      figure,
    );
    plot.over.addEventListener("click", () => {
      const left = plot.cursor.left ?? -1;
      if (left >= 0) this.go(plot.posToVal(left, "x"));
    });
    const line = document.createElement("div");
    line.className = "now";
    plot.over.append(line);
    return { plot, line };
  }

  private fit(): void {
    const width = this.root.clientWidth;
    if (width === this.width) return;
    if (this.drawn.length === 0) {
      this.show(this.chosen);
      return;
    }
    this.width = width;
    for (const { plot } of this.drawn) plot.setSize({ width, height: HEIGHT_PX });
    this.at(this.position_s);
  }
}

/** Return from where to where values are drawn; those that are all the same have a little room, too. */
function spanOf(_plot: uPlot, least: number | null, most: number | null): uPlot.Range.MinMax {
  if (least === null || most === null) return [0, 1];
  return most - least < FLAT ? [least - 0.5, most + 0.5] : uPlot.rangeNum(least, most, 0.1, true);
}

function note(words: string): HTMLElement {
  const paragraph = document.createElement("p");
  paragraph.className = "quiet";
  paragraph.textContent = words;
  return paragraph;
}

/** Say what the curves are under the pointer. */
function tellValues(plot: uPlot, target: HTMLElement, { colours, unit, decimals }: Table): void {
  const { idx } = plot.cursor;
  const parts = colours.map((colour, index) => {
    const value = idx == null ? null : nearest(plot.data[index + 1], idx);
    const part = document.createElement("span");
    part.dataset["colour"] = String(colour);
    part.textContent = value === null ? "" : `${figureText(value, decimals)} ${unit}`;
    return part;
  });
  target.replaceChildren(...parts);
}

/** Return the value at a place, or just before it: not every curve has one for every time. */
function nearest(values: ArrayLike<number | null | undefined> | undefined, index: number): number | null {
  for (let back = 0; back < 8; back++) {
    const value = values?.[index - back];
    if (value === null) return null;
    if (value !== undefined) return value;
  }
  return null;
}
