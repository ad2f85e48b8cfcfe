/** What the tracker knows, in words, and what would make it better. */

import { adviceOf, headingWords, placeWords, type Shown } from "../../web/src/advice";
import type { CameraPose } from "../../web/src/wire";

const DEGREE = Math.PI / 180;

function pose(sigma_m: number, sigma_deg: number, more: Partial<CameraPose> = {}): CameraPose {
  const covariance = new Array(36).fill(0);
  covariance[0] = covariance[7] = sigma_m ** 2;
  covariance[35] = (sigma_deg * DEGREE) ** 2;
  const T_site_cam = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 2, 0, 0, 0, 1];
  return { T_site_cam, covariance, headingKnown: true, isTruth: false, ...more } as CameraPose;
}
const shown = (more: Partial<Shown>): Shown => ({
  style: "ghost",
  nearEdge: false,
  pose: pose(2, 3),
  kind: "live",
  aligning: false,
  ...more,
});

test("place and direction are said with how well they are known", () => {
  expect(placeWords(pose(1.8, 2))).toBe("to about 1.8 m");
  expect(headingWords(pose(1.8, 2))).toBe("north, to 2.0°");
  expect(headingWords(pose(1.8, 2, { headingKnown: false }))).toBe("not known yet");
  expect(placeWords(pose(0, 0, { isTruth: true }))).toBe("exactly");
  expect(headingWords(pose(0, 0, { isTruth: true }))).toBe("north, exactly");
  expect(placeWords(pose(3, 0, { isTruth: true }))).toBe("to about 3.0 m");
});

test("where all is as it should be nothing is said", () => {
  expect(adviceOf(shown({ style: "locked", pose: pose(0.5, 0.5) }))).toBeNull();
  expect(adviceOf(shown({ style: "none", pose: null }))).toBeNull();
  expect(adviceOf(shown({ aligning: true }))).toBeNull();
});

test("a ghost says how far it may be off, and what to do", () => {
  expect(adviceOf(shown({}))).toBe("An outline: the square may be 2.5 m aside. Align it, or walk on until I am surer.");
  expect(adviceOf(shown({ kind: "replay" }))).toBe("An outline: the square may be 2.5 m aside here.");
});

test("where nothing is drawn, it is said whether place or direction is the matter", () => {
  expect(adviceOf(shown({ style: "guide", pose: pose(2, 20) }))).toMatch(/where you look: walk/);
  expect(adviceOf(shown({ style: "guide", pose: pose(20, 2) }))).toMatch(/where you are: go/);
  expect(adviceOf(shown({ style: "guide", pose: pose(20, 2), kind: "replay" }))).toMatch(/where the visitor is/);
  expect(adviceOf(shown({ style: "guide", pose: pose(2, 20), kind: "replay" }))).toMatch(/where the visitor looks/);
});

test("a heading that nothing has told is another sentence's", () => {
  expect(adviceOf(shown({ style: "guide", pose: pose(2, 20, { headingKnown: false }) }))).toBeNull();
});

test("an edge comes first, for who walks as a warning", () => {
  expect(adviceOf(shown({ nearEdge: true }))).toMatch(/^Mind your step/);
  expect(adviceOf(shown({ nearEdge: true, style: "locked" }))).toMatch(/^Mind your step/);
  expect(adviceOf(shown({ nearEdge: true, kind: "replay" }))).toMatch(/^Near an edge/);
});
