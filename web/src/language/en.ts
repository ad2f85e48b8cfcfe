/**
 * What the pages say in English. Every other language has the same keys: see `catalogue.ts`.
 *
 * Names in braces are filled in; a text that depends on a count has forms, `{ one, other }`, by the plural rules of its language.
 */

export const en = {
  language: "Language",
  "language.name": "English",
} as const;
