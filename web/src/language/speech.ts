/** What the pages say, in the language that is spoken: English until another one is chosen. */

import { type Catalogue, fill, type Given, type Key, numberText, unitText } from "./catalogue";

export type { Key } from "./catalogue";

const found = import.meta.glob<Readonly<Record<string, Catalogue>>>("./??.ts", { eager: true });
const catalogues: Readonly<Record<string, Catalogue>> = Object.assign({}, ...Object.values(found));

/** The languages that there are, by their two letters. */
export const LANGUAGES: readonly string[] = Object.keys(catalogues).sort();

let spoken = "en";

/** Speak one of the languages that there are from now on. */
export function speak(code: string): void {
  if (!(code in catalogues)) throw new Error(`no catalogue of ${code}: there are ${LANGUAGES.join(", ")}`);
  spoken = code;
}

/** Return the language that is spoken: "en". */
export function language(): string {
  return spoken;
}

/** Return languages in the order in which a text of the site is looked for: the one that is spoken, then what a browser wishes. */
export function languages(browser: readonly string[]): readonly string[] {
  return [spoken, ...browser];
}

/** Return a text in the language that is spoken. */
export function say<K extends Key>(key: K, ...given: Given<K>): string {
  return fill(textOf(spoken, key), spoken, given[0] ?? {});
}

/** Return a language's name as its speakers write it. */
export function nameOf(code: string): string {
  return fill(textOf(code, "language.name"), code, {});
}

/** Whether a text of that name is there: for names that come from a page. */
export function isKey(name: string | undefined): name is Key {
  return name !== undefined && name in textsOf("en");
}

/** Return a number in the language that is spoken. */
export function sayNumber(value: number, decimals = 0): string {
  return numberText(value, spoken, decimals);
}

/** Return a length in the language that is spoken, its unit in full where it is read aloud: "22 metres". */
export function sayLength(
  value: number,
  unit: "meter" | "centimeter" | "kilometer",
  decimals = 0,
  width: "short" | "long" = "short",
): string {
  return unitText(value, unit, spoken === "en" ? "en-GB" : spoken, decimals, width);
}

function textsOf(code: string): Catalogue {
  const texts = catalogues[code];
  if (texts === undefined) throw new Error(`no catalogue of ${code}`);
  return texts;
}

function textOf(code: string, key: Key): Catalogue[Key] {
  return textsOf(code)[key];
}
