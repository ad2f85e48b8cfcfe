/** What somebody sees of the site, from its plan: which way they face, what stands ahead, to the left and to the right, and how far. Pure. */

import type { Pair } from "./lens";
import { contains, type Place } from "./plan";

/** Where an eye is and where it looks; lengths in metres, site frame. */
export interface Standpoint {
  readonly e_m: number;
  readonly n_m: number;
  readonly u_m: number;
  /** Clockwise from north. */
  readonly heading_rad: number;
  /** How far is seen to either side of the heading. */
  readonly half_rad: number;
}

/** Something that stands on the site, as a prism over its footprint. */
export interface Solid {
  readonly id: string;
  readonly footprint: readonly Place[];
  readonly base_m: number;
  readonly height_m: number;
}

export type Side = "ahead" | "left" | "right";

/** One thing that is seen, and how far its nearest seen point is; ahead, how far it is along the heading. */
export interface Sight {
  readonly id: string;
  readonly side: Side;
  readonly distance_m: number;
}

export interface Description {
  readonly heading_rad: number;
  /** The smallest thing that one stands in or on. */
  readonly at: string | null;
  /** How high the eye is over that, metres. */
  readonly above_m: number;
  /** At most one for each side, ahead first; nothing is told twice. */
  readonly sights: readonly Sight[];
}

const DEGREE = Math.PI / 180;
/** Between two directions that are looked along. */
const STEP_RAD = DEGREE;
/** So far off the heading is still ahead, where nothing is on it. */
const AHEAD_RAD = 10 * DEGREE;
/** What is seen less high than this is passed over. */
const LEAST_RAD = 0.5 * DEGREE;
/** What is lower is paving. */
const FLAT_M = 0.3;

/** Return what is seen from a standpoint. */
export function describe(from: Standpoint, solids: readonly Solid[]): Description {
  const place: Place = [from.e_m, from.n_m];
  const under = solids
    .filter(({ footprint }) => contains(footprint, place))
    .sort((a, b) => areaOf(a.footprint) - areaOf(b.footprint))[0];
  const standing = solids.filter(({ height_m, footprint }) => height_m > FLAT_M && !contains(footprint, place));
  const steps = Math.floor(from.half_rad / STEP_RAD + 1e-9);
  const seen = new Map<string, Glimpse[]>();
  for (let i = -steps; i <= steps; i++)
    for (const glimpse of along(from, i * STEP_RAD, standing))
      seen.set(glimpse.id, [...(seen.get(glimpse.id) ?? []), glimpse]);
  const ahead = aheadOf([...seen.values()].flat());
  const without = (...told: (Sight | null)[]): Glimpse[][] =>
    [...seen.entries()].filter(([id]) => !told.some((sight) => sight?.id === id)).map(([, glimpses]) => glimpses);
  const left = sideOf("left", without(ahead));
  const sides = [ahead, left, sideOf("right", without(ahead, left))];
  return {
    heading_rad: from.heading_rad,
    at: under?.id ?? null,
    above_m: from.u_m - (under?.base_m ?? 0),
    sights: sides.filter((sight) => sight !== null),
  };
}

/** One direction's view of one thing. */
interface Glimpse {
  readonly id: string;
  /** Clockwise from the heading. */
  readonly turn_rad: number;
  readonly distance_m: number;
  /** How much of its height is seen over what stands before it. */
  readonly shown_rad: number;
}

/** Return what is seen in one direction: each thing as far as it rises above all that stand before it. */
function along(from: Standpoint, turn_rad: number, solids: readonly Solid[]): Glimpse[] {
  const bearing = from.heading_rad + turn_rad;
  const way: Pair = [Math.sin(bearing), Math.cos(bearing)];
  const met = solids.flatMap((solid) => {
    const span = spanOf([from.e_m, from.n_m], way, solid.footprint);
    return span === null ? [] : [{ solid, span }];
  });
  met.sort((a, b) => a.span[0] - b.span[0]);
  let horizon_rad = -Math.PI / 2;
  return met.flatMap(({ solid, span: [near_m, far_m] }) => {
    const [foot_m, top_m] = [solid.base_m - from.u_m, solid.base_m + solid.height_m - from.u_m];
    // the top of what is lower than the eye is seen to its far edge
    const top_rad = Math.atan2(top_m, top_m > 0 ? near_m : far_m);
    const shown_rad = top_rad - Math.max(horizon_rad, Math.atan2(foot_m, near_m));
    horizon_rad = Math.max(horizon_rad, top_rad);
    return shown_rad < LEAST_RAD ? [] : [{ id: solid.id, turn_rad, distance_m: near_m, shown_rad }];
  });
}

/** Return how near and how far a ray is inside an outline, metres; null where it misses it. */
function spanOf([e, n]: Place, [de, dn]: Pair, outline: readonly Place[]): Pair | null {
  const hits = outline.flatMap(([e1, n1], index) => {
    const [e0, n0] = outline[(index + outline.length - 1) % outline.length] ?? [e1, n1];
    const [ve, vn] = [e1 - e0, n1 - n0];
    const across = de * vn - dn * ve;
    if (across === 0) return [];
    const distance_m = ((e0 - e) * vn - (n0 - n) * ve) / across;
    const share = ((e0 - e) * dn - (n0 - n) * de) / across;
    return distance_m > 0 && share >= 0 && share <= 1 ? [distance_m] : [];
  });
  return hits.length === 0 ? null : [Math.min(...hits), Math.max(...hits)];
}

/** Return what rises highest on the heading; where nothing does, what is next to it. */
function aheadOf(glimpses: readonly Glimpse[]): Sight | null {
  const near = glimpses.filter(({ turn_rad }) => Math.abs(turn_rad) <= AHEAD_RAD);
  const [best] = [...near].sort(
    (a, b) => Math.abs(a.turn_rad) - Math.abs(b.turn_rad) || b.shown_rad - a.shown_rad || a.distance_m - b.distance_m,
  );
  return best === undefined ? null : { id: best.id, side: "ahead", distance_m: best.distance_m };
}

/** Return what takes up most of one side. */
function sideOf(side: "left" | "right", things: readonly (readonly Glimpse[])[]): Sight | null {
  const sign = side === "left" ? -1 : 1;
  const parts = things
    .map((glimpses) => glimpses.filter(({ turn_rad }) => turn_rad * sign > 0))
    .map((glimpses) => ({ glimpses, much_rad: glimpses.reduce((sum, { shown_rad }) => sum + shown_rad, 0) }))
    .sort((a, b) => b.much_rad - a.much_rad);
  const [first] = parts[0]?.glimpses ?? [];
  if (first === undefined) return null;
  const distance_m = Math.min(...(parts[0]?.glimpses ?? []).map((glimpse) => glimpse.distance_m));
  return { id: first.id, side, distance_m };
}

function areaOf(outline: readonly Place[]): number {
  const twice = outline.reduce((sum, [e1, n1], index) => {
    const [e0, n0] = outline[(index + outline.length - 1) % outline.length] ?? [e1, n1];
    return sum + e0 * n1 - e1 * n0;
  }, 0);
  return Math.abs(twice) / 2;
}
