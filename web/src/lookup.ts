/**
 * Where each place of the original picture lies in the undistorted drawing of the model: a grid, worked out once per lens.
 *
 * The model is drawn by an exact pinhole into a window of ideal coordinates; the picture stays in its own pixels and each
 * of its places reads the drawing at its undistorted coordinate. No three.js in here.
 */

import { domainRadius, idealAt, type Lens, type Pair } from "./lens";

/** A rectangle of ideal coordinates (x/z, y/z; y down). */
export interface Window {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

export interface Lookup {
  readonly columns: number;
  readonly rows: number;
  readonly window: Window;
  /** Per node: picture place in pixels from the picture's top-left CORNER, x then y. */
  readonly places_px: Float32Array;
  /** Per node: texture coordinates in the drawing, (0, 0) bottom left; meaningless where not `known`. */
  readonly uv: Float32Array;
  /** Per node: 1 inside the lens model, 0 outside. */
  readonly known: Float32Array;
}

/** How wide a cell may be, the widest first: as wide as the lens allows, for each costs time where there is no card. */
const CELLS_PX = [32, 16] as const;
/** So far off linear in between may be, pixels; where even the narrowest cells are further off, they are halved. */
const NEARLY_PX = 0.05;
/** Ideal coordinates wider than this (72 degrees off the axis) cost more pixels than they are worth. */
const WIDEST_WINDOW = 3;

/** Work out the lookup of a lens. */
export function buildLookup(lens: Lens): Lookup {
  const straight =
    lens.model === "none" || (lens.coefficients.every((value) => value === 0) && lens.model !== "equidistant");
  const { columns, rows, nodes } = straight ? gridOf(lens, 1, 1) : gridFor(lens);
  const window = windowOf(nodes.map((node) => node.ideal));
  const places_px = new Float32Array(nodes.length * 2);
  const uv = new Float32Array(nodes.length * 2);
  const known = new Float32Array(nodes.length);
  nodes.forEach(({ place, ideal }, i) => {
    places_px.set(place, 2 * i);
    if (ideal === null || !inside(window, ideal)) return;
    known[i] = 1;
    uv[2 * i] = (ideal[0] - window.left) / (window.right - window.left);
    uv[2 * i + 1] = (window.bottom - ideal[1]) / (window.bottom - window.top);
  });
  return { columns, rows, window, places_px, uv, known };
}

interface Node {
  readonly place: Pair;
  readonly ideal: Pair | null;
}

interface Grid {
  readonly columns: number;
  readonly rows: number;
  readonly nodes: readonly Node[];
}

/** Return the coarsest grid that says what the lens says. */
function gridFor(lens: Lens): Grid {
  let grid = gridOf(lens, 1, 1);
  for (const cell_px of CELLS_PX) {
    const [columns, rows] = [Math.ceil(lens.width_px / cell_px), Math.ceil(lens.height_px / cell_px)];
    grid = gridOf(lens, 2 * columns, 2 * rows);
    if (unevenness(lens, grid) < NEARLY_PX) return { columns, rows, nodes: everySecond(grid) };
  }
  return grid;
}

function gridOf(lens: Lens, columns: number, rows: number): Grid {
  const radius = domainRadius(lens);
  const nodes: Node[] = [];
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column <= columns; column++) {
      const place: Pair = [(column / columns) * lens.width_px, (row / rows) * lens.height_px];
      nodes.push({ place, ideal: idealAt(lens, [place[0] - 0.5, place[1] - 0.5], radius) });
    }
  }
  return { columns, rows, nodes };
}

function everySecond({ columns, nodes }: Grid): readonly Node[] {
  return nodes.filter((_, i) => (i % (columns + 1)) % 2 === 0 && Math.floor(i / (columns + 1)) % 2 === 0);
}

/** Return how far, pixels, the nodes between every second ones are from the middles of those; infinite beyond the lens model. */
function unevenness(lens: Lens, { columns, rows, nodes }: Grid): number {
  let worst_px = 0;
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column <= columns; column++) {
      const [right, down] = [column % 2, row % 2]; // of a cell's middle: its two triangles meet from top right to bottom left
      const at = (i: number, j: number): Pair | null => nodes[j * (columns + 1) + i]?.ideal ?? null;
      const [own, one, other] = [at(column, row), at(column + right, row - down), at(column - right, row + down)];
      if (!own || !one || !other) return Number.POSITIVE_INFINITY;
      const dx_px = lens.fx_px * (own[0] - (one[0] + other[0]) / 2);
      const dy_px = lens.fy_px * (own[1] - (one[1] + other[1]) / 2);
      worst_px = Math.max(worst_px, Math.hypot(dx_px, dy_px));
    }
  }
  return worst_px;
}

/** Return the smallest window with all the known nodes, no wider than a drawing can afford. */
function windowOf(ideals: readonly (Pair | null)[]): Window {
  let [left, right, top, bottom] = [-1e-3, 1e-3, -1e-3, 1e-3];
  for (const ideal of ideals) {
    if (ideal === null) continue;
    left = Math.min(left, Math.max(ideal[0], -WIDEST_WINDOW));
    right = Math.max(right, Math.min(ideal[0], WIDEST_WINDOW));
    top = Math.min(top, Math.max(ideal[1], -WIDEST_WINDOW));
    bottom = Math.max(bottom, Math.min(ideal[1], WIDEST_WINDOW));
  }
  return { left, right, top, bottom };
}

function inside(window: Window, [x, y]: Pair): boolean {
  return x >= window.left && x <= window.right && y >= window.top && y <= window.bottom;
}

/** Return the drawing's size for a picture shown at `scale` screen pixels a pixel: at least as fine as the screen. */
export function drawingSize(lens: Lens, window: Window, scale: number, limit_px: number): Pair {
  const width = (window.right - window.left) * lens.fx_px * scale;
  const height = (window.bottom - window.top) * lens.fy_px * scale;
  const shrink = Math.min(1, limit_px / width, limit_px / height);
  return [Math.max(1, Math.round(width * shrink)), Math.max(1, Math.round(height * shrink))];
}
