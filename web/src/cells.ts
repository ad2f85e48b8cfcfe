/** The squares of ground that wide things are cut into: the rule of `assets/levels.py`, with the sizes that the files tell. Pure. */

export interface Cells {
  /** Within this distance of the origin, east and north, cells are `side_m` wide, `wide_side_m` beyond. */
  readonly near_m: number;
  readonly side_m: number;
  readonly wide_side_m: number;
  /** Added to the numbers of the wide cells. */
  readonly far: number;
}

/** Read the sizes; null where a file tells none, and nothing is cut. */
export function parseCells(value: unknown): Cells | null {
  if (typeof value !== "object" || value === null) return null;
  const { near_m, side_m, wide_side_m, far } = value as Record<string, unknown>;
  if (![near_m, side_m, wide_side_m, far].every((size) => typeof size === "number" && size > 0)) return null;
  return { near_m, side_m, wide_side_m, far } as Cells;
}

/** Return the cell of a place as `COLUMN,ROW`. */
export function cellOf({ near_m, side_m, wide_side_m, far }: Cells, east_m: number, north_m: number): string {
  const near = Math.max(Math.abs(east_m), Math.abs(north_m)) < near_m;
  const number = (metres: number): number =>
    near ? Math.floor(metres / side_m) : Math.floor(metres / wide_side_m) + far;
  return `${number(east_m)},${number(north_m)}`;
}
