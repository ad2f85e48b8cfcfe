/** The two times of the square, and which of them an address shows first. Pure. */

import type { Site } from "../site";
import type { Shown } from "./address";

/** From the first to the last in time's backward order: the share is how much is shown of the last. */
export const EPOCHS = ["today", "roman"] as const;
export type Epoch = (typeof EPOCHS)[number];

/** Return the one of which most is shown at first. */
export function firstOf(site: Site, { past }: Shown): Epoch {
  if (past !== null) return past > 0.5 ? "roman" : "today";
  return "roman" in site.models ? "roman" : "today";
}
