/** The texts of the pages: each that is used exists, none is unused, and every language says the same things. */

import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { type Catalogue, type Forms, fill, type Key } from "../../web/src/language/catalogue";
import { chosenOf } from "../../web/src/language/choice";
import { en } from "../../web/src/language/en";
import { LANGUAGES, language, nameOf, say, sayLength, sayNumber, speak } from "../../web/src/language/speech";

const WEB = fileURLToPath(new URL("../../web", import.meta.url));
const catalogues = Object.fromEntries(
  Object.entries(
    import.meta.glob<Readonly<Record<string, Catalogue>>>("../../web/src/language/??.ts", { eager: true }),
  ).map(([path, module]) => [path.slice(-5, -3), Object.values(module)[0] as Catalogue]),
);
const KEYS = Object.keys(en) as Key[];
const LISTED = LANGUAGES.flatMap((code) => KEYS.map((key) => [code, key] as const));

afterEach(() => speak("en"));

function filesBelow(folder: string): string[] {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
    const path = `${folder}/${entry.name}`;
    if (entry.isDirectory()) return filesBelow(path);
    return /\/language\/..\.ts$/.test(path) ? [] : [path];
  });
}

const SOURCES = filesBelow(`${WEB}/src`).filter((path) => path.endsWith(".ts"));
const PAGES = readdirSync(WEB)
  .filter((name) => name.endsWith(".html"))
  .map((name) => `${WEB}/${name}`);

function formsOf(text: string | Forms): string[] {
  return typeof text === "string" ? [text] : Object.values(text);
}

function namesIn(text: string | Forms): string[] {
  return [...new Set(formsOf(text).flatMap((form) => [...form.matchAll(/\{(\w+)\}/g)].map(([, name]) => name ?? "")))];
}

test("English, Turkish and whatever lies beside them are found, each by a name of its own", () => {
  expect(LANGUAGES).toEqual(expect.arrayContaining(["en", "tr"]));
  expect(new Set(LANGUAGES.map(nameOf)).size).toBe(LANGUAGES.length);
});

test("every mark of a page names a text that needs no values", () => {
  for (const page of PAGES)
    for (const [, key = ""] of readFileSync(page, "utf8").matchAll(/data-say(?:-label|-title)?="([^"]*)"/g)) {
      expect(KEYS, `${page}: ${key}`).toContain(key);
      expect(namesIn(en[key as Key]), key).toEqual([]);
    }
});

test("no text is unused", () => {
  const used = [...SOURCES, ...PAGES].map((path) => readFileSync(path, "utf8")).join("\n");
  const names = new Set([...used.matchAll(/"([\w.-]+)"/g)].map(([, name]) => name));
  // `replay.curve.${name}` and startsWith("told.") use all that begin so
  const beginnings = [...used.matchAll(/(?:`|startsWith\(")([\w-]+\.[\w.-]*)(?:\$\{|"\))/g)].map(
    ([, beginning]) => beginning ?? "",
  );
  const isUsed = (key: string): boolean =>
    names.has(key) || beginnings.some((beginning) => key.startsWith(beginning) && key !== beginning);
  expect(KEYS.filter((key) => !isUsed(key))).toEqual([]);
});

test.each(LANGUAGES)("every text of %s has the values of the English one, and no more keys", (code) => {
  const catalogue = catalogues[code];
  expect(Object.keys(catalogue ?? {}).sort()).toEqual([...KEYS].sort());
  for (const key of KEYS)
    expect(namesIn(catalogue?.[key] ?? "").sort(), `${code}: ${key}`).toEqual(namesIn(en[key]).sort());
});

test.each(LISTED)("%s says %s in a text that is whole", (code, key) => {
  for (const form of formsOf(catalogues[code]?.[key] ?? "")) {
    expect(form.trim()).toBe(form);
    expect(form).not.toBe("");
    expect(form.replace(/\{\w+\}/g, "")).not.toMatch(/[{}<>]/);
  }
});

test("a count takes the form that its language has for it", () => {
  const forms = { one: "{count} step", other: "{count} steps" };
  expect([0, 1, 2, 1500].map((count) => fill(forms, "en", { count }))).toEqual([
    "0 steps",
    "1 step",
    "2 steps",
    "1,500 steps",
  ]);
  const polish = { one: "{count} krok", few: "{count} kroki", other: "{count} kroków" };
  expect([1, 3, 5].map((count) => fill(polish, "pl", { count }))).toEqual(["1 krok", "3 kroki", "5 kroków"]);
});

test("numbers and lengths are written as the language writes them", () => {
  expect([sayNumber(1234.5, 1), sayLength(0.84, "meter", 1), sayLength(22, "meter", 0, "long")]).toEqual([
    "1,234.5",
    "0.8 m",
    "22 metres",
  ]);
  speak("tr");
  expect(language()).toBe("tr");
  expect([sayNumber(1234.5, 1), sayLength(0.84, "meter", 1), sayLength(22, "meter", 0, "long")]).toEqual([
    "1.234,5",
    "0,8 m",
    "22 metre",
  ]);
  expect(say("language")).toBe("Dil");
  expect(() => speak("xx")).toThrow("no catalogue of xx");
});

test.each([
  ["tr", null, [], "tr"],
  ["tr-TR", "en", ["en"], "tr"],
  [null, "tr", ["en-GB"], "tr"],
  ["xx", null, ["de-DE", "tr-TR", "en"], "tr"],
  [null, null, ["de", "fr"], "en"],
  ["", "", [], "en"],
] as const)("asked %s, stored %s, browser %s: %s", (asked, stored, browser, chosen) => {
  expect(chosenOf(["en", "tr"], asked, stored, browser)).toBe(chosen);
});
