/** The evidence's colours: told apart by every kind of colour vision, and never the only carrier. */

import { EVIDENCE, EVIDENCE_COLOURS, EVIDENCE_WORDS, parseEvidence } from "../../web/src/evidence";
import { say } from "../../web/src/language/speech";

type Rgb = readonly [number, number, number];

/** Machado, Oliveira and Fernandes (2009), severity 1, for linear RGB. */
const SIGHT: Readonly<Record<string, readonly [Rgb, Rgb, Rgb]>> = {
  usual: [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  "without red": [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  "without green": [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  "without blue": [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
};

function linear(css: string): Rgb {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const value = Number.parseInt(css.slice(at, at + 2), 16) / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return [r ?? 0, g ?? 0, b ?? 0];
}

function dot(a: Rgb, b: Rgb): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** CIE L*a*b*, D65. */
function lab(rgb: Rgb): Rgb {
  const f = (t: number): number => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116);
  const x = f(dot([0.4124, 0.3576, 0.1805], rgb) / 0.9505);
  const y = f(dot([0.2126, 0.7152, 0.0722], rgb));
  const z = f(dot([0.0193, 0.1192, 0.9505], rgb) / 1.089);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

for (const [sight, rows] of Object.entries(SIGHT)) {
  test(`no two colours look alike to sight ${sight}`, () => {
    const seen = EVIDENCE.map((evidence) => {
      const rgb = linear(EVIDENCE_COLOURS[evidence]);
      const [r, g, b] = rows.map((row) => Math.min(1, Math.max(0, dot(row, rgb))));
      return lab([r ?? 0, g ?? 0, b ?? 0]);
    });
    seen.forEach((one, i) => {
      for (const other of seen.slice(i + 1))
        expect(Math.hypot(...one.map((value, axis) => value - (other[axis] ?? 0)))).toBeGreaterThan(25);
    });
  });
}

test("each level of evidence is said in words that begin with its name", () => {
  for (const evidence of EVIDENCE) expect(say(EVIDENCE_WORDS[evidence]).toLowerCase().startsWith(evidence)).toBe(true);
  expect(new Set(Object.values(EVIDENCE_WORDS)).size).toBe(3);
});

test("only the three levels of evidence are read", () => {
  expect(EVIDENCE.map(parseEvidence)).toEqual(EVIDENCE);
  expect([null, "", "Attested", 1, {}].map(parseEvidence)).toEqual([null, null, null, null, null]);
});
