/** A description of the view in words, to be read or spoken: "You face north. Ahead, 22 metres away: Basilica Stoa." Pure. */

import type { Description, Side } from "./describe";
import { type Key, say, sayLength } from "./language/speech";

const FACING = [
  "facing.n",
  "facing.ne",
  "facing.e",
  "facing.se",
  "facing.s",
  "facing.sw",
  "facing.w",
  "facing.nw",
] as const satisfies readonly Key[];
const SIDES = { ahead: "sight.ahead", left: "sight.left", right: "sight.right" } as const satisfies Record<Side, Key>;
/** An eye that is higher than this looks down on the site. */
const HIGH_M = 5;

/** Return a description in words; `names` are the things', by id. */
export function descriptionWords(description: Description, names: ReadonlyMap<string, string>): string {
  const { heading_rad, at, above_m, sights } = description;
  const eighth = ((Math.round(heading_rad / (Math.PI / 4)) % 8) + 8) % 8;
  const sentences = [say(FACING[eighth] ?? "facing.n")];
  if (above_m > HIGH_M) sentences.push(say("sight.above", { far: metres(above_m) }));
  for (const { id, side, distance_m } of sights)
    sentences.push(say(SIDES[side], { name: names.get(id) ?? id, far: metres(distance_m) }));
  if (sights.length === 0) sentences.push(say("sight.nothing"));
  if (at !== null && above_m <= HIGH_M) sentences.push(say("sight.at", { name: names.get(at) ?? at }));
  return sentences.join(" ");
}

/** Whole metres, and never none: who stands before a wall is still before it. */
function metres(distance_m: number): string {
  return sayLength(Math.max(1, Math.round(distance_m)), "meter", 0, "long");
}
