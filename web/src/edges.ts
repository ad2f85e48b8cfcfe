/**
 * Where a visitor could fall or trip: places near which what one walks on drops, rises, or ends over nothing. Pure.
 *
 * Worked out from the walkable surface (its stairs are slopes) and the outlines of what stands: an end of the surface is a
 * drop unless something stands there. Steep ground counts as steps. Unknown unknowns, like a fresh hole, are not in a model.
 */

import type { Vector3 } from "./frames";

/** A triangle of the site frame, three corners. */
export type Triangle = readonly [Vector3, Vector3, Vector3];

const CELL_M = 0.5;
/** Ground that rises more than this from one cell to the next is a step, or as steep as one: 24 degrees. */
const STEP_M = 0.22;
/** Edges further away than this are no concern yet. */
const FARTHEST_M = 8;

/** The edges of a site. */
export class Edges {
  private readonly heights = new Map<number, number>();
  private readonly edges = new Set<number>();

  /** `solids` are what stands, from above: nobody falls where a wall is. */
  constructor(walkable: Iterable<Triangle>, solids: Iterable<Triangle>) {
    for (const triangle of walkable) raster(triangle, (cell, z) => this.note(cell, z));
    const walls = new Set<number>();
    for (const triangle of solids) raster(triangle, (cell) => walls.add(cell));
    for (const [cell, z] of this.heights) {
      for (const beside of neighbours(cell)) {
        const other = this.heights.get(beside);
        const isEdge = other === undefined ? !nearWall(walls, beside) : Math.abs(other - z) > STEP_M;
        if (isEdge) this.edges.add(cell);
      }
    }
  }

  /** Whether nothing is known of any ground. */
  get isEmpty(): boolean {
    return this.heights.size === 0;
  }

  /** Return the height of the ground at a place; null where nobody can stand. */
  groundAt(e_m: number, n_m: number): number | null {
    return this.heights.get(cellAt(e_m, n_m)) ?? null;
  }

  /** Return how far the nearest edge is, metres, at most `FARTHEST_M`. */
  distance(e_m: number, n_m: number): number {
    const reach = Math.ceil(FARTHEST_M / CELL_M);
    const [i0, j0] = [Math.floor(e_m / CELL_M), Math.floor(n_m / CELL_M)];
    let nearest = FARTHEST_M;
    for (let i = i0 - reach; i <= i0 + reach; i++) {
      for (let j = j0 - reach; j <= j0 + reach; j++) {
        if (!this.edges.has(key(i, j))) continue;
        nearest = Math.min(nearest, Math.hypot((i + 0.5) * CELL_M - e_m, (j + 0.5) * CELL_M - n_m));
      }
    }
    return nearest;
  }

  private note(cell: number, z: number): void {
    const before = this.heights.get(cell);
    if (before === undefined || z > before) this.heights.set(cell, z);
  }
}

/** Cells are numbered by rows of this many: a site is smaller than 16 km. */
const ROW = 32768;

function key(i: number, j: number): number {
  return (i + ROW / 2) * ROW + (j + ROW / 2);
}

function cellAt(e_m: number, n_m: number): number {
  return key(Math.floor(e_m / CELL_M), Math.floor(n_m / CELL_M));
}

function neighbours(cell: number): readonly number[] {
  return [cell - 1, cell + 1, cell - ROW, cell + ROW];
}

/** The surface keeps clear of what stands by the width of a body: a wall begins in the cell behind. */
function nearWall(walls: ReadonlySet<number>, cell: number): boolean {
  return walls.has(cell) || neighbours(cell).some((beside) => walls.has(beside));
}

/** Call `visit` for each cell whose middle lies in a triangle seen from above, with the height there. */
function raster([a, b, c]: Triangle, visit: (cell: number, z: number) => void): void {
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (Math.abs(area) < 1e-9) return;
  const low = (axis: 0 | 1): number => Math.floor(Math.min(a[axis], b[axis], c[axis]) / CELL_M - 0.5);
  const high = (axis: 0 | 1): number => Math.ceil(Math.max(a[axis], b[axis], c[axis]) / CELL_M - 0.5);
  for (let i = low(0); i <= high(0); i++) {
    for (let j = low(1); j <= high(1); j++) {
      const [e, n] = [(i + 0.5) * CELL_M, (j + 0.5) * CELL_M];
      const s = ((e - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (n - a[1])) / area;
      const t = ((b[0] - a[0]) * (n - a[1]) - (e - a[0]) * (b[1] - a[1])) / area;
      if (s < -1e-6 || t < -1e-6 || s + t > 1 + 1e-6) continue;
      visit(key(i, j), a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]));
    }
  }
}
