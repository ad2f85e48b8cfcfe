/** What is told apart by colour: motion models as on the console, and viewers by their numbers. */

import { Color } from "three";
import { motionColour } from "../words";

/** Seven that are told apart by those who see no red or no green, too (Okabe and Ito 2008); never the only carrier. */
const VIEWERS = ["#56b4e9", "#e69f00", "#009e73", "#f0e442", "#cc79a7", "#0072b2", "#d55e00"] as const;

const known = new Map<string | null, Color>();

/** Return the colour of a motion model. */
export function colourOfMotion(model: string | null): Color {
  const colour = known.get(model) ?? new Color(motionColour(model));
  known.set(model, colour);
  return colour;
}

/** Return the colour of the viewer with that number, from one. */
export function colourOfViewer(number: number): string {
  return VIEWERS[(((number - 1) % VIEWERS.length) + VIEWERS.length) % VIEWERS.length] ?? VIEWERS[0];
}
