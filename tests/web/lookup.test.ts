/** The lookup grid: between its nodes it must say what the lens says. */

import { type Lens, type LensModel, type Pair, project } from "../../web/src/lens";
import { buildLookup, drawingSize, type Lookup } from "../../web/src/lookup";
import { forSeeds } from "./random";

const SIZE = { width_px: 640, height_px: 480, fx_px: 520, fy_px: 515, cx_px: 321.3, cy_px: 238.6 };
const LENSES: readonly Lens[] = (
  [
    ["none", []],
    ["plumb_bob", [-0.09, 0.02, 0.0005, -0.0004, 0]],
    ["plumb_bob", [-0.28, 0.07, 0.0005, -0.0004, 0]],
    ["rational_polynomial", [0.31, 0.04, 0.0004, -0.0003, 0.001, 0.65, 0.12, 0.005]],
    ["equidistant", [0.0034, 0.00072, -0.0021, 0.0002]],
  ] as const
).map(([model, given]) => ({
  ...SIZE,
  model: model as LensModel,
  coefficients: [...given, ...new Array<number>(8 - given.length).fill(0)],
}));
/** A tenth of what can be seen, at the corners of the strongest lens. */
const GRID_ERROR_PX = 0.1;

/** Return the drawing's texture coordinate at a place of the picture, as the graphics card interpolates a cell's two triangles. */
function readGrid({ columns, rows, uv }: Lookup, [u_px, v_px]: Pair): Pair {
  const x = (u_px / SIZE.width_px) * columns;
  const y = (v_px / SIZE.height_px) * rows;
  const column = Math.min(Math.floor(x), columns - 1);
  const row = Math.min(Math.floor(y), rows - 1);
  const [fx, fy] = [x - column, y - row];
  const node = (right: number, down: number): Pair => {
    const i = 2 * ((row + down) * (columns + 1) + column + right);
    return [uv[i] ?? Number.NaN, uv[i + 1] ?? Number.NaN];
  };
  const mix = (weights: readonly (readonly [Pair, number])[]): Pair => [
    weights.reduce((sum, [corner, weight]) => sum + corner[0] * weight, 0),
    weights.reduce((sum, [corner, weight]) => sum + corner[1] * weight, 0),
  ];
  if (fx + fy <= 1)
    return mix([
      [node(0, 0), 1 - fx - fy],
      [node(1, 0), fx],
      [node(0, 1), fy],
    ]);
  return mix([
    [node(1, 1), fx + fy - 1],
    [node(1, 0), 1 - fy],
    [node(0, 1), 1 - fx],
  ]);
}

describe.each(LENSES)("$model $coefficients.0", (lens) => {
  const lookup = buildLookup(lens);

  test("covers the picture with a grid", () => {
    expect(lookup.known.length).toBe((lookup.columns + 1) * (lookup.rows + 1));
    expect([...lookup.places_px.slice(0, 2)]).toEqual([0, 0]);
    expect([...lookup.places_px.slice(-2)]).toEqual([lens.width_px, lens.height_px]);
    expect(lookup.known.every((known) => known === 1)).toBe(true);
  });

  test("every place reads the drawing where the lens sees it", () => {
    const { left, right, top, bottom } = lookup.window;
    forSeeds(300, (random) => {
      const place: Pair = [random.between(0, lens.width_px), random.between(0, lens.height_px)];
      const [u, v] = readGrid(lookup, place);
      expect(Math.min(u, v)).toBeGreaterThanOrEqual(0);
      expect(Math.max(u, v)).toBeLessThanOrEqual(1);
      const ideal: Pair = [left + u * (right - left), bottom - v * (bottom - top)];
      const pixel = project(lens, [...ideal, 1]);
      expect(pixel).not.toBeNull();
      // places count from the picture's corner, pixels from the centre of the first one
      const [x, y] = pixel ?? [Number.NaN, Number.NaN];
      expect(Math.hypot(x + 0.5 - place[0], y + 0.5 - place[1])).toBeLessThan(GRID_ERROR_PX);
    });
  });
});

test("cells are as wide as the lens allows", () => {
  const columns = LENSES.map((lens) => buildLookup(lens).columns);
  expect(columns[0]).toBe(1);
  expect(columns[1]).toBeLessThan(columns[2] ?? 0);
  for (const lens of LENSES.slice(2)) expect(buildLookup(lens).columns).toBe(SIZE.width_px / 8);
});

test("places outside the lens model are marked, and do not widen the window", () => {
  const wide: Lens = { ...SIZE, fx_px: 200, fy_px: 200, model: "plumb_bob", coefficients: [-0.3, 0, 0, 0, 0, 0, 0, 0] };
  const { known, window } = buildLookup(wide);
  expect(known[0]).toBe(0);
  expect(known[Math.floor(known.length / 2)]).toBe(1);
  expect(Math.max(window.right, window.bottom, -window.left, -window.top)).toBeLessThan(1.1);
});

test("the drawing is as fine as the screen, keeps its shape, and stays within what a card can hold", () => {
  forSeeds(50, (random) => {
    const window = {
      left: random.between(-2, -0.1),
      right: random.between(0.1, 2),
      top: random.between(-2, -0.1),
      bottom: random.between(0.1, 2),
    };
    const lens = { ...SIZE, model: "none" as const, coefficients: [] };
    const [scale, limit] = [random.between(0.5, 4), 2048];
    const [width, height] = drawingSize(lens, window, scale, limit);
    const [fullWidth, fullHeight] = [
      (window.right - window.left) * SIZE.fx_px * scale,
      (window.bottom - window.top) * SIZE.fy_px * scale,
    ];
    const shrink = Math.min(1, limit / fullWidth, limit / fullHeight);
    expect(Math.abs(width - fullWidth * shrink)).toBeLessThanOrEqual(0.5);
    expect(Math.abs(height - fullHeight * shrink)).toBeLessThanOrEqual(0.5);
    expect(Math.max(width, height)).toBeLessThanOrEqual(limit);
  });
  expect(
    drawingSize({ ...SIZE, model: "none", coefficients: [] }, { left: 0, right: 0, top: 0, bottom: 0 }, 1, 99),
  ).toEqual([1, 1]);
});
