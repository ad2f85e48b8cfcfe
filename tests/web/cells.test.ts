/** The squares of ground that wide things are cut into. */

import { cellOf, parseCells } from "../../web/src/cells";

const CELLS = { near_m: 144, side_m: 48, wide_side_m: 288, far: 1000 };

test("a place is in the cell of its column and row, near the origin in a small one", () => {
  expect(cellOf(CELLS, 0, 47.9)).toBe("0,0");
  expect(cellOf(CELLS, -0.1, 48)).toBe("-1,1");
  expect(cellOf(CELLS, 143.9, -143.9)).toBe("2,-3");
  expect(cellOf(CELLS, 144, 0)).toBe("1000,1000");
  expect(cellOf(CELLS, 0, -300)).toBe("1000,998");
});

test("sizes are read as a file tells them, and nothing else is taken for sizes", () => {
  expect(parseCells(CELLS)).toEqual(CELLS);
  for (const value of [null, undefined, 3, {}, { ...CELLS, side_m: 0 }, { ...CELLS, far: "1000" }])
    expect(parseCells(value)).toBeNull();
});
