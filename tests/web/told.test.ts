/** What servers tell, in the visitor's language: all that they can tell is known. */

import { readFileSync } from "node:fs";
import { LANGUAGES, speak } from "../../web/src/language/speech";
import { told } from "../../web/src/language/told";

const { sentences }: { readonly sentences: readonly string[] } = JSON.parse(
  readFileSync(new URL("../golden/sentences.json", import.meta.url), "utf8"),
);
/** Said to programs and to operators' consoles alone. */
const NOT_FOR_VISITORS = [
  "A setting is written KEY=VALUE: `agora settings` lists them all.",
  "An alignment is a tap, a place, or the taking back of one.",
  "Sharing is switched by true or false.",
];
const FOR_VISITORS = sentences.filter((sentence) => !NOT_FOR_VISITORS.includes(sentence));

afterEach(() => speak("en"));

test.each(FOR_VISITORS)("in English: %s", (sentence) => {
  expect(told(sentence)).toBe(sentence);
});

test.each(LANGUAGES.filter((code) => code !== "en").flatMap((code) => FOR_VISITORS.map((one) => [code, one] as const)))(
  "in %s: %s",
  (code, sentence) => {
    speak(code);
    const said = told(sentence);
    expect(said).not.toBe(sentence);
    expect(said).not.toMatch(/\b(?:The|This|check|sensor|undefined)\b|[{}]/);
  },
);

test("values and reasons are kept, and the longest sentence is meant", () => {
  speak("tr");
  expect(told("The recording breaks off after 84 s; it plays to there.")).toContain("84");
  expect(told("The camera is gone: the cable was pulled. It is looked for again and again.")).toBe(
    "Kamera kayboldu: the cable was pulled. Tekrar tekrar aranıyor.",
  );
  expect(told("The GPS receiver has said nothing for 60 s: check its plug and its antenna.")).toBe(
    "GPS alıcısı 60 saniyedir susuyor: fişini ve antenini kontrol edin.",
  );
});

test("a sentence of a newer server stays as it is", () => {
  speak("tr");
  expect(told("The moon is full.")).toBe("The moon is full.");
});
