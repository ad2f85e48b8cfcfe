/** A plan of the site from above, north up: its outlines, the visitor's place and cone of view, and the way to the square. Pure. */

import { type Key, say } from "./language/speech";
import type { Pair } from "./lens";
import { compassPoint, metresText } from "./words";

/** East and north, metres. */
export type Place = Pair;

/** What of the plan is shown, metres; `south` less than `north`. */
export interface Frame {
  readonly west: number;
  readonly south: number;
  readonly east: number;
  readonly north: number;
}

const MARGIN_M = 12;
/** Who is further away than this is shown at the plan's rim. */
const CONE_M = 26;

/** Return the smallest frame with all outlines and a margin. */
export function frameOf(outlines: readonly (readonly Place[])[]): Frame {
  const places = outlines.flat();
  if (places.length === 0) return { west: -50, south: -50, east: 50, north: 50 };
  const [east, north] = [places.map(([e]) => e), places.map(([, n]) => n)];
  return {
    west: Math.min(...east) - MARGIN_M,
    south: Math.min(...north) - MARGIN_M,
    east: Math.max(...east) + MARGIN_M,
    north: Math.max(...north) + MARGIN_M,
  };
}

/** Return the middle of a frame. */
export function middleOf({ west, south, east, north }: Frame): Place {
  return [(west + east) / 2, (south + north) / 2];
}

/** Return an SVG path of an outline; y grows to the south there. */
export function outlinePath(outline: readonly Place[]): string {
  return `M${outline.map(([e, n]) => `${round(e)},${round(-n)}`).join("L")}Z`;
}

/** Return an SVG path of the cone that a visitor sees, `half_rad` to either side of the heading. */
export function conePath([e, n]: Place, heading_rad: number, half_rad: number): string {
  const half = Math.min(Math.max(half_rad, 0.05), Math.PI * 0.95);
  const at = (angle: number): string =>
    `${round(e + CONE_M * Math.sin(angle))},${round(-(n + CONE_M * Math.cos(angle)))}`;
  const large = half > Math.PI / 2 ? 1 : 0;
  return `M${round(e)},${round(-n)}L${at(heading_rad - half)}A${CONE_M},${CONE_M} 0 ${large} 1 ${at(heading_rad + half)}Z`;
}

/** Return a place as it is shown: on the rim where it lies outside. */
export function within([e, n]: Place, { west, south, east, north }: Frame): Place {
  return [Math.min(Math.max(e, west), east), Math.min(Math.max(n, south), north)];
}

/** Whether a place lies inside an outline. */
export function contains(outline: readonly Place[], [e, n]: Place): boolean {
  let inside = false;
  outline.forEach(([e1, n1], index) => {
    const [e0, n0] = outline[(index + outline.length - 1) % outline.length] ?? [0, 0];
    if (n1 > n !== n0 > n && e < ((e0 - e1) * (n - n1)) / (n0 - n1) + e1) inside = !inside;
  });
  return inside;
}

/** The way to a goal. */
export interface Way {
  readonly distance_m: number;
  /** Clockwise from north. */
  readonly bearing_rad: number;
  /** Clockwise from where the visitor looks, (-pi, pi]; null where nobody knows. */
  readonly turn_rad: number | null;
}

/** Return the way from a place to a goal; the heading is null where it is not known. */
export function wayTo(from: Place, heading_rad: number | null, goal: Place): Way {
  const [east, north] = [goal[0] - from[0], goal[1] - from[1]];
  const bearing_rad = (Math.atan2(east, north) + 2 * Math.PI) % (2 * Math.PI);
  const turn = heading_rad === null ? null : bearing_rad - heading_rad;
  return {
    distance_m: Math.hypot(east, north),
    bearing_rad,
    turn_rad: turn === null ? null : Math.atan2(Math.sin(turn), Math.cos(turn)),
  };
}

/** By the eighth of a turn, from behind over the left, ahead and the right to behind again. */
const WAYS = [
  "way.behind",
  "way.behind_left",
  "way.left",
  "way.ahead_left",
  "way.ahead",
  "way.ahead_right",
  "way.right",
  "way.behind_right",
  "way.behind",
] as const satisfies readonly Key[];

/** Return the way in words: "The square is 40 m ahead, to your left." */
export function wayWords({ distance_m, bearing_rad, turn_rad }: Way): string {
  const far = metresText(distance_m);
  if (turn_rad === null) return say("way.to_the", { far, point: compassPoint(bearing_rad) });
  const eighth = Math.round(turn_rad / (Math.PI / 4)) + 4;
  return say(WAYS[eighth] ?? "way.behind", { far });
}

function round(value: number): string {
  return value.toFixed(1);
}
