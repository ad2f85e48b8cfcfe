/** Alignment by the visitor: what a tap may mean, what a drag turns, and what is said of the result. */

import {
  adviceFor,
  candidates,
  draggedPose,
  hereSigma,
  improvementWords,
  sightOf,
  spreadOf,
  tapSigma,
} from "../../web/src/alignment";
import { compose, headingOf, invertRigid, type Matrix4, transform, type Vector3 } from "../../web/src/frames";
import { type Lens, project } from "../../web/src/lens";
import { forSeeds } from "./random";

const LENS: Lens = {
  width_px: 640,
  height_px: 480,
  fx_px: 520,
  fy_px: 510,
  cx_px: 321.3,
  cy_px: 238.6,
  model: "plumb_bob",
  coefficients: [-0.09, 0.02, 0.0005, -0.0004, 0],
};
/** At (10, 20, 1.6), looking north, level. */
const NORTH: Matrix4 = [1, 0, 0, 10, 0, 0, 1, 20, 0, -1, 0, 1.6, 0, 0, 0, 1];
const DEGREE = Math.PI / 180;
const landmark = (id: string, point_site_m: Vector3) => ({ id, name: id, point_site_m });
const AHEAD = landmark("ahead", [10, 60, 3]);
const LEFT = landmark("left", [0, 60, 3]);
const BEHIND = landmark("behind", [10, -30, 3]);
const FAR_BEHIND = landmark("far behind", [10, -90, 3]);

describe("what a tap may mean", () => {
  const at = (point: Vector3) => project(LENS, transform(invertRigid(NORTH), point)) ?? [Number.NaN, Number.NaN];

  test("the landmark that is thought to be seen nearest comes first, those behind last, the nearer first", () => {
    const all = [FAR_BEHIND, BEHIND, LEFT, AHEAD];
    const names = (tap: readonly [number, number]) => candidates(all, tap, LENS, NORTH).map((one) => one.landmark.id);
    expect(names(at(AHEAD.point_site_m))).toEqual(["ahead", "left", "behind", "far behind"]);
    expect(names(at(LEFT.point_site_m))).toEqual(["left", "ahead", "behind", "far behind"]);
    expect(candidates(all, at(LEFT.point_site_m), LENS, NORTH)[0]?.off_px).toBeCloseTo(0, 6);
    expect(candidates([BEHIND], [9, 9], LENS, NORTH)[0]).toMatchObject({ off_px: null });
  });

  test("without a pose all are told in their own order", () => {
    expect(candidates([BEHIND, AHEAD], [0, 0], LENS, null)).toEqual([
      { landmark: BEHIND, off_px: null, distance_m: null },
      { landmark: AHEAD, off_px: null, distance_m: null },
    ]);
  });

  test("a finger is worse than a mouse, and a large picture has more pixels", () => {
    expect(tapSigma("touch", 1)).toBeGreaterThan(tapSigma("mouse", 1));
    expect(tapSigma("touch", 3)).toBe(3 * tapSigma("touch", 1));
    expect(tapSigma("mouse", 0.01)).toBe(1.5);
    expect(hereSigma("touch", 0.5)).toBe(4);
    expect(hereSigma("mouse", 0.01)).toBe(0.7);
    expect(hereSigma("touch", 1000)).toBe(100);
  });
});

describe("dragging", () => {
  test("a direction is that of the pixel", () => {
    forSeeds(20, (random) => {
      const T = compose(NORTH, random.rigid(5));
      const pixel: [number, number] = [random.between(5, 635), random.between(5, 475)];
      const sight = sightOf(LENS, T, pixel) ?? [Number.NaN, 0, 0];
      expect(Math.hypot(...sight)).toBeCloseTo(1, 9);
      const eye = transform(T, [0, 0, 0]);
      const far = [0, 1, 2].map((i) => (eye[i] ?? 0) + 30 * (sight[i] ?? 0)) as unknown as Vector3;
      const seen = project(LENS, transform(invertRigid(T), far)) ?? [Number.NaN, Number.NaN];
      expect(seen[0]).toBeCloseTo(pixel[0], 6);
      expect(seen[1]).toBeCloseTo(pixel[1], 6);
    });
  });

  test("what was seen at the first pixel is seen straight above or below the second", () => {
    const [from, to] = [
      [300, 240],
      [420, 200],
    ] as const;
    const turned = draggedPose(LENS, NORTH, from, to);
    const sight = sightOf(LENS, NORTH, from) ?? [0, 0, 0];
    const point: Vector3 = [10 + 40 * sight[0], 20 + 40 * sight[1], 1.6 + 40 * sight[2]];
    const now = sightOf(LENS, turned, to) ?? [0, 0, 0];
    expect(Math.atan2(now[1], now[0])).toBeCloseTo(Math.atan2(point[1] - 20, point[0] - 10), 9);
    expect(transform(turned, [0, 0, 0])).toEqual([expect.closeTo(10), expect.closeTo(20), expect.closeTo(1.6)]);
    expect(headingOf(turned)).toBeGreaterThan(Math.PI);
    expect(draggedPose(LENS, NORTH, from, from)).toEqual(NORTH.map((value) => expect.closeTo(value, 9)));
  });
});

describe("what is said", () => {
  const doubt = (place_m: number, degrees: number) => ({ place_m, heading_rad: degrees * DEGREE });

  test("what is better is said with what it was before", () => {
    expect(improvementWords(doubt(1.8, 6), doubt(0.8, 0.4))).toBe(
      "Better: the direction is known to 0.4° (6.0° before), your place to 0.8 m (1.8 m before).",
    );
    expect(improvementWords(doubt(1.8, 6), doubt(1.8, 1))).toBe(
      "Better: the direction is known to 1.0° (6.0° before).",
    );
    const unknown = { place_m: 1, heading_rad: Number.POSITIVE_INFINITY };
    expect(improvementWords(unknown, doubt(1, 2))).toBe("Better: the direction is known to 2.0°.");
  });

  test("what is not better is not called so", () => {
    expect(improvementWords(doubt(1.8, 1), doubt(1.79, 0.99))).toMatch(/changed little.*take it back/);
    expect(improvementWords(doubt(1, 1), doubt(2, 2))).toMatch(/changed little/);
  });

  test("how far bearings are spread does not hang on where north is", () => {
    expect(spreadOf([])).toBe(0);
    expect(spreadOf([1])).toBeCloseTo(0, 9);
    expect(spreadOf([350 * DEGREE, 10 * DEGREE])).toBeCloseTo(20 * DEGREE, 9);
    expect(spreadOf([0, 100 * DEGREE, 200 * DEGREE])).toBeCloseTo(200 * DEGREE, 9);
  });

  test("three landmarks, spread over a quarter, are enough", () => {
    expect(adviceFor([])).toMatch(/Tap a landmark/);
    expect(adviceFor([0])).toMatch(/Turn/);
    expect(adviceFor([0, 0.2, 0.4])).toMatch(/Turn/);
    expect(adviceFor([0, 2])).toMatch(/one more/);
    expect(adviceFor([0, 1, 2])).toMatch(/Done/);
  });
});
