/** What the page says: one sentence for what stands in the way, and numbers with their units. */

import {
  compassPoint,
  degreesText,
  headingSigma,
  horizontalSigma,
  metresText,
  motionColour,
  motionWords,
  newsOf,
  type Situation,
  sentenceFor,
} from "../../web/src/words";
import colours from "../golden/motion_colours.json";
import { forSeeds } from "./random";

const WELL: Situation = {
  connection: "open",
  kind: "replay",
  playing: true,
  sincePicture_ms: 20,
  sinceOpened_ms: 60_000,
  hasPose: true,
  headingKnown: true,
  notice: null,
  health: {},
  asked: null,
  model: "shown",
  drawingLost: false,
  garbled: false,
};
const ESTIMATORS = ["camera-gps-imu/famm", "camera-gps-imu/precise"] as const;
const MODELS = [0, 1, 2].flatMap((i) => [0, 1, 2].map((j) => `P${i}R${j}`));

test("when all is well nothing is said, and a notice of the server's is passed on", () => {
  expect(sentenceFor(WELL)).toBeNull();
  expect(sentenceFor({ ...WELL, notice: "This walk has no camera." })).toBe("This walk has no camera.");
});

/** From the most pressing to the least: each must be said even where all below it are true as well. */
const TROUBLES: readonly (readonly [Partial<Situation>, RegExp])[] = [
  [{ drawingLost: true }, /^The browser has stopped drawing/],
  [{ connection: "refused" }, /may not watch/],
  [{ connection: "other version" }, /load it anew/],
  [{ connection: "no session" }, /^Nobody is walking/],
  [{ connection: "lost" }, /connection is lost/],
  [{ connection: "connecting" }, /^Connecting/],
  [{ sincePicture_ms: null }, /No pictures/],
  [{ garbled: true }, /cannot be read/],
  [{ health: { gps: { trouble: true, sentence: "The GPS receiver is gone." } } }, /receiver is gone/],
  [{ model: "failed" }, /model of the square could not/],
  [{ hasPose: false }, /Finding out where you are/],
  [{ headingKnown: false }, /find north/],
  [{ model: "loading" }, /^The square is on its way/],
  [{ notice: "A notice." }, /A notice/],
];

test.each(TROUBLES.map(([trouble, words], i) => [words.source, trouble, words, i] as const))(
  "says %s before anything less pressing",
  (_name, trouble, words, i) => {
    expect(sentenceFor({ ...WELL, ...trouble })).toMatch(words);
    const lesser = Object.assign({}, ...TROUBLES.slice(i + 1).map(([each]) => each)) as Partial<Situation>;
    expect(sentenceFor({ ...WELL, ...lesser, ...trouble })).toMatch(words);
  },
);

test("every sentence is one sentence, in plain words", () => {
  for (const [trouble] of TROUBLES) {
    const sentence = sentenceFor({ ...WELL, ...trouble }) ?? "";
    expect(sentence).toMatch(/^[A-Z].*[.…?]$/);
    expect(sentence).not.toMatch(/undefined|null|NaN|WebSocket|error/);
  }
});

test("a sensor that goes and one that is back are said once each", () => {
  const well = { gps: { trouble: false, sentence: "The GPS receiver is well: 10 messages a second." } };
  const gone = { gps: { trouble: true, sentence: "The GPS receiver is gone: plug it in." } };
  expect(newsOf({}, well)).toBeNull();
  expect(newsOf({}, gone)).toBe("The GPS receiver is gone: plug it in.");
  expect(newsOf(well, gone)).toBe("The GPS receiver is gone: plug it in.");
  expect(newsOf(gone, gone)).toBeNull();
  expect(newsOf(gone, well)).toBe("The GPS receiver is back.");
  expect(newsOf({ lidar: gone.gps }, { lidar: well.gps })).toBe("The lidar is back.");
  expect(newsOf(gone, {})).toBeNull();
});

test("pictures that stay away are explained by the camera's own words", () => {
  const camera = { trouble: true, sentence: "The camera is not there: plug it in." };
  const live: Situation = { ...WELL, kind: "live", sincePicture_ms: 9000 };
  expect(sentenceFor(live)).toMatch(/is the rig running/);
  expect(sentenceFor({ ...live, health: { camera } })).toBe(camera.sentence);
});

test("a walk that the address names is named where there is none", () => {
  const sentence = sentenceFor({ ...WELL, connection: "no session", asked: "tuesday" });
  expect(sentence).toMatch(/^There is no walk named tuesday here/);
});

test("a page that has just opened waits before it complains", () => {
  const fresh = { ...WELL, sinceOpened_ms: 100, sincePicture_ms: null };
  expect(sentenceFor(fresh)).toBeNull();
  expect(sentenceFor({ ...fresh, connection: "connecting" })).toBeNull();
  expect(sentenceFor({ ...fresh, sincePicture_ms: 20, model: "loading" })).toBeNull();
});

test("pictures that stay away are missed while playing, not while pausing", () => {
  expect(sentenceFor({ ...WELL, sincePicture_ms: 10_000 })).toMatch(/No pictures/);
  expect(sentenceFor({ ...WELL, sincePicture_ms: 10_000, playing: false })).toBeNull();
  expect(sentenceFor({ ...WELL, sincePicture_ms: null, playing: false })).toMatch(/[Pp]ress play/);
  expect(sentenceFor({ ...WELL, sincePicture_ms: null, kind: "live" })).toMatch(/rig/);
});

test("motion models have the console's colours", () => {
  for (const [model, colour] of Object.entries(colours.models)) expect(motionColour(model)).toBe(colour);
  expect(Object.keys(colours.models)).toEqual(MODELS);
  expect(motionColour(null)).toBe(colours.none);
});

test("each of the nine motion models has words and a colour of its own; anything else has none", () => {
  expect(new Set(ESTIMATORS.flatMap((estimator) => MODELS.map((model) => motionWords(model, estimator)))).size).toBe(
    18,
  );
  expect(new Set(MODELS.map(motionColour)).size).toBe(9);
  for (const other of [null, "", "P3R0", "P0", "-"]) {
    for (const estimator of ESTIMATORS) expect(motionWords(other, estimator)).toBe("no motion model");
    expect(MODELS.map(motionColour)).not.toContain(motionColour(other));
  }
});

test("a motion model is worded as its estimator means it: the paper's coefficients, or what the walker does", () => {
  expect(motionWords("P0R2", "gps-imu/famm")).toBe("position held, turning doubled");
  expect(motionWords("P0R2", "camera-gps-imu/precise")).toBe("standing, view turning fast");
  expect(motionWords("P1R0", "gps-imu/precise")).toBe("walking, view still");
  expect(motionWords("P2R1", "camera-gps-imu/imm")).toBe("position doubled, turning steady");
});

test.each([
  [0, "0 cm"],
  [0.04, "4 cm"],
  [0.0949, "9 cm"],
  [0.1, "0.1 m"],
  [0.84, "0.8 m"],
  [9.94, "9.9 m"],
  [9.96, "10 m"],
  [12.3, "12 m"],
  [Number.NaN, "–"],
  [Number.POSITIVE_INFINITY, "–"],
])("%s metres are %s", (metres, text) => {
  expect(metresText(metres)).toBe(text);
});

test.each([
  [0, "0.0°"],
  [0.00698, "0.4°"],
  [0.2094, "12°"],
  [4, "unknown"],
  [Number.NaN, "–"],
])("%s radians are %s", (radians, text) => {
  expect(degreesText(radians)).toBe(text);
});

test("lengths and angles never read smaller as they grow", () => {
  const value = (text: string): number => Number.parseFloat(text) * (text.endsWith("cm") ? 0.01 : 1);
  forSeeds(200, (random) => {
    const a = 10 ** random.between(-3, 2);
    const b = a * random.between(1, 2);
    expect(value(metresText(b))).toBeGreaterThanOrEqual(value(metresText(a)));
    if (b < Math.PI) expect(value(degreesText(b))).toBeGreaterThanOrEqual(value(degreesText(a)));
  });
});

test("a compass point is the nearest of eight, whole turns aside", () => {
  const points = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];
  points.forEach((point, i) => {
    forSeeds(10, (random) => {
      const eighth = Math.PI / 4;
      const heading_rad = i * eighth + random.between(-0.49, 0.49) * eighth + (random.below(5) - 2) * 2 * Math.PI;
      expect(compassPoint(heading_rad)).toBe(point);
    });
  });
});

test("the horizontal sigma is that of the worst direction", () => {
  forSeeds(100, (random) => {
    const [a, b] = [random.between(0.1, 9), random.between(0.1, 9)];
    const angle = random.between(0, Math.PI);
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const covariance = new Array<number>(36).fill(0);
    covariance[0] = a * a * c * c + b * b * s * s;
    covariance[1] = (a * a - b * b) * c * s;
    covariance[6] = (a * a - b * b) * c * s;
    covariance[7] = a * a * s * s + b * b * c * c;
    expect(horizontalSigma(covariance)).toBeCloseTo(Math.max(a, b), 9);
  });
});

test("the heading's sigma is the last of the diagonal", () => {
  const covariance = Array.from({ length: 36 }, (_, i) => i);
  expect(headingSigma(covariance)).toBe(Math.sqrt(35));
  expect(headingSigma([])).toBe(0);
});
