/** The ground that can be walked on, as exact heights of its triangles, and round things that stand on it. Pure; site frame. */

import type { Triangle } from "../edges";
import type { Vector3 } from "../frames";
import type { Place } from "../plan";
import type { Post } from "./post";

/** What is looked up lies in cells of this side. */
const CELL_M = 4;
/** Pieces of the surface meet, but for the rounding of their file. */
const CRACK_M = 0.02;
/** The half width of a body: so near does its middle come to a post. */
export const BODY_M = 0.25;
/** A post ends above the knee, or is stepped over. */
const KNEE_M = 0.4;
const ROW = 8192;

export class Ground {
  private readonly triangles = new Map<number, Triangle[]>();
  private readonly posts = new Map<number, Post[]>();
  private readonly cells: readonly number[];

  constructor(triangles: Iterable<Triangle>, posts: Iterable<Post> = []) {
    for (const triangle of triangles) {
      const [e, n] = [triangle.map(([x]) => x), triangle.map(([, y]) => y)];
      const low: Place = [Math.min(...e) - CRACK_M, Math.min(...n) - CRACK_M];
      const high: Place = [Math.max(...e) + CRACK_M, Math.max(...n) + CRACK_M];
      for (const cell of cellsOf(low, high)) push(this.triangles, cell, triangle);
    }
    this.put(posts);
    this.cells = [...this.triangles.keys()];
  }

  /** Put posts on it. */
  put(posts: Iterable<Post>): void {
    for (const post of posts) {
      const reach = post.radius_m + BODY_M;
      const [low, high]: Place[] = [
        [post.e_m - reach, post.n_m - reach],
        [post.e_m + reach, post.n_m + reach],
      ];
      if (low && high) for (const cell of cellsOf(low, high)) push(this.posts, cell, post);
    }
  }

  /** Return the highest ground at a place between two heights; null where nobody can stand. */
  heightAt([e, n]: Place, lowest_m: number, highest_m: number): number | null {
    let best: number | null = null;
    for (const triangle of this.triangles.get(cellAt(e, n)) ?? []) {
      const z = heightIn(triangle, e, n);
      if (z !== null && z >= lowest_m && z <= highest_m && (best === null || z > best)) best = z;
    }
    return best !== null && this.isBlocked(e, n, best) ? null : best;
  }

  /** Return the place to stand that is nearest to a point of the plan; null where there is no ground at all. */
  nearest([e, n]: Place): Vector3 | null {
    const here = this.heightAt([e, n], Number.NEGATIVE_INFINITY, Number.POSITIVE_INFINITY);
    if (here !== null) return [e, n, here];
    let best: Vector3 | null = null;
    let least = Number.POSITIVE_INFINITY;
    for (const cell of this.cells) {
      const [ce, cn] = middleOf(cell);
      if (Math.hypot(ce - e, cn - n) - CELL_M > least) continue;
      for (const triangle of this.triangles.get(cell) ?? []) {
        // well inside a triangle: its edges may be the surface's
        const spot = towards(triangle, [e, n]);
        const away = Math.hypot(spot[0] - e, spot[1] - n);
        const z = away < least ? this.heightAt([spot[0], spot[1]], spot[2] - 0.01, spot[2] + 0.01) : null;
        if (z !== null) [best, least] = [[spot[0], spot[1], z], away];
      }
    }
    return best;
  }

  private isBlocked(e: number, n: number, z: number): boolean {
    return (this.posts.get(cellAt(e, n)) ?? []).some(
      (post) =>
        post.bottom_m <= z + 1 &&
        post.top_m > z + KNEE_M &&
        Math.hypot(post.e_m - e, post.n_m - n) < post.radius_m + BODY_M,
    );
  }
}

function push<T>(map: Map<number, T[]>, cell: number, value: T): void {
  const list = map.get(cell);
  if (list) list.push(value);
  else map.set(cell, [value]);
}

function cellAt(e: number, n: number): number {
  return (Math.floor(e / CELL_M) + ROW / 2) * ROW + (Math.floor(n / CELL_M) + ROW / 2);
}

function middleOf(cell: number): Place {
  return [(Math.floor(cell / ROW) - ROW / 2 + 0.5) * CELL_M, ((cell % ROW) - ROW / 2 + 0.5) * CELL_M];
}

function* cellsOf(low: Place, high: Place): Iterable<number> {
  for (let i = Math.floor(low[0] / CELL_M); i <= Math.floor(high[0] / CELL_M); i++)
    for (let j = Math.floor(low[1] / CELL_M); j <= Math.floor(high[1] / CELL_M); j++)
      yield cellAt((i + 0.5) * CELL_M, (j + 0.5) * CELL_M);
}

/** Return the height of a triangle at a place that lies in it, or in a crack beside it. */
function heightIn([a, b, c]: Triangle, e: number, n: number): number | null {
  const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
  if (Math.abs(area) < 1e-6) return null;
  const s = ((e - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (n - a[1])) / area;
  const t = ((b[0] - a[0]) * (n - a[1]) - (e - a[0]) * (b[1] - a[1])) / area;
  const slack = (side: number): number => (-CRACK_M * side) / Math.abs(area);
  if (s < slack(Math.hypot(c[0] - a[0], c[1] - a[1])) || t < slack(Math.hypot(b[0] - a[0], b[1] - a[1]))) return null;
  if (1 - s - t < slack(Math.hypot(c[0] - b[0], c[1] - b[1]))) return null;
  return a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2]);
}

/** Return the point of a triangle that lies nearest to a place, drawn in a little. */
function towards(triangle: Triangle, [e, n]: Place): Vector3 {
  const middle = mean(triangle);
  let best: Vector3 = middle;
  let least = Math.hypot(middle[0] - e, middle[1] - n);
  for (let i = 0; i < 3; i++) {
    const [a, b] = [triangle[i], triangle[(i + 1) % 3]];
    if (!a || !b) continue;
    const [de, dn] = [b[0] - a[0], b[1] - a[1]];
    const along = Math.min(1, Math.max(0, ((e - a[0]) * de + (n - a[1]) * dn) / (de * de + dn * dn || 1)));
    const on: Vector3 = [a[0] + along * de, a[1] + along * dn, a[2] + along * (b[2] - a[2])];
    const away = Math.hypot(on[0] - e, on[1] - n);
    if (away < least) [best, least] = [mix(on, middle, 0.02), away];
  }
  return best;
}

function mean([a, b, c]: Triangle): Vector3 {
  return [(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3];
}

function mix(a: Vector3, b: Vector3, share: number): Vector3 {
  return [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])];
}
