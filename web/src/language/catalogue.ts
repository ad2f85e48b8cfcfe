/**
 * What a catalogue of texts is, and how a text of it is filled in. Pure.
 *
 * `en.ts` is the type of all: a catalogue without one of its keys, or with another one, does not compile. A language is
 * one more file beside it, named by its two letters.
 */

import type { en } from "./en";

/** A text by the count that it tells of; which forms there are is the language's own affair. */
export type Forms = Partial<Record<Intl.LDMLPluralRule, string>> & { readonly other: string };

export type Key = keyof typeof en;
export type Catalogue = Readonly<Record<Key, string | Forms>>;

/** The names between braces: "name" and "far" of "{name} is {far} ahead". */
type Names<T> = T extends string
  ? T extends `${string}{${infer Name}}${infer Rest}`
    ? Name | Names<Rest>
    : never
  : T extends { readonly other: infer Text }
    ? Names<Text> | "count"
    : never;

/** What must be given with a text: nothing, or a value for each of its names. */
export type Given<K extends Key> = [Names<(typeof en)[K]>] extends [never]
  ? []
  : [values: Readonly<Record<Names<(typeof en)[K]>, string | number>>];

/** Return a text with its values put in; a number is written as the language writes numbers. */
export function fill(text: string | Forms, code: string, values: Readonly<Record<string, string | number>>): string {
  const form = typeof text === "string" ? text : (text[pluralOf(code, Number(values["count"]))] ?? text.other);
  return form.replace(/\{(\w+)\}/g, (_whole, name: string) => {
    const value = values[name];
    return typeof value === "number" ? numberText(value, code, 0) : (value ?? "");
  });
}

/** Return a number as a language writes it, with so many decimals. */
export function numberText(value: number, code: string, decimals: number): string {
  return formatter(code, { minimumFractionDigits: decimals, maximumFractionDigits: decimals }).format(value);
}

/** Return a number with its unit as a language writes it: "0.8 m", "0,8 m". */
export function unitText(
  value: number,
  unit: "meter" | "centimeter" | "kilometer",
  code: string,
  decimals: number,
  width: "short" | "long" = "short",
): string {
  const digits = { minimumFractionDigits: decimals, maximumFractionDigits: decimals };
  return formatter(code, { style: "unit", unit, unitDisplay: width, ...digits }).format(value);
}

const formatters = new Map<string, Intl.NumberFormat>();
const plurals = new Map<string, Intl.PluralRules>();

/** Making one takes longer than using it a thousand times. */
function formatter(code: string, options: Intl.NumberFormatOptions): Intl.NumberFormat {
  const name = code + JSON.stringify(options);
  const known = formatters.get(name) ?? new Intl.NumberFormat(code, options);
  formatters.set(name, known);
  return known;
}

function pluralOf(code: string, count: number): Intl.LDMLPluralRule {
  const known = plurals.get(code) ?? new Intl.PluralRules(code);
  plurals.set(code, known);
  return known.select(count);
}
