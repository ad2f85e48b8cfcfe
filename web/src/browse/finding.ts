/** Finding a monument: by words of its name, and the view that shows it. Pure; site frame. */

import type { Vector3 } from "../frames";
import type { Place } from "../plan";
import type { Monument } from "../site";
import { type Eye, looking } from "./eye";

/** Letters that are no other letter with a mark. */
const PLAIN: Readonly<Record<string, string>> = { ı: "i", ø: "o", ß: "ss", æ: "ae" };

/** Return a text as it is compared: without capitals and marks. */
export function plainText(text: string): string {
  return text
    .toLowerCase()
    .normalize("NFD")
    .replace(/\p{M}/gu, "")
    .replace(/[ıøßæ]/g, (letter) => PLAIN[letter] ?? letter);
}

/** Return the monuments with all words of a text in their names, in the order of their names. */
export function found(monuments: readonly Monument[], text: string, language: string): readonly Monument[] {
  const words = plainText(text).split(/\s+/);
  return monuments
    .filter(({ name, id, footprint }) => {
      const names = `${plainText(name)} ${id.replace(/_/g, " ")}`;
      return footprint.length > 2 && words.every((word) => names.includes(word));
    })
    .sort((a, b) => a.name.localeCompare(b.name, language));
}

/** How far one stands back: as far again as the monument is large, and some steps. */
const BACK = 1.5;
const STEPS_BACK_M = 12;
const LOOK_DOWN = 0.42;

/** Return a view of what stands on an outline, from above and from the middle of the square, and how far its middle is. */
export function overlooking(outline: readonly Place[], square: Place): { readonly eye: Eye; readonly about_m: number } {
  const middle: Place = [mean(outline.map(([e]) => e)), mean(outline.map(([, n]) => n))];
  const radius_m = Math.max(...outline.map(([e, n]) => Math.hypot(e - middle[0], n - middle[1])));
  const way: Place = [square[0] - middle[0], square[1] - middle[1]];
  const length_m = Math.hypot(...way);
  // what lies in the middle itself is looked at from the south
  const [e, n] = length_m < 1 ? [0, -1] : [way[0] / length_m, way[1] / length_m];
  const back_m = BACK * radius_m + STEPS_BACK_M;
  const from: Vector3 = [middle[0] + e * back_m, middle[1] + n * back_m, 4 + LOOK_DOWN * back_m];
  const at: Vector3 = [middle[0], middle[1], 4];
  return { eye: looking(from, at), about_m: Math.hypot(back_m, from[2] - at[2]) };
}

function mean(values: readonly number[]): number {
  return values.reduce((sum, value) => sum + value, 0) / Math.max(1, values.length);
}
