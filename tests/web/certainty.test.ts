/** The style of the overlay by the doubt, and how it changes from picture to picture. */

import { Certainty, type Doubt, DWELL_NS, doubtOf, LIMITS, styleAt } from "../../web/src/certainty";
import type { CameraPose } from "../../web/src/wire";
import { forSeeds } from "./random";

const DEGREE = Math.PI / 180;
const doubt = (place_m: number, heading_deg: number): Doubt => ({ place_m, heading_rad: heading_deg * DEGREE });
const SURE = doubt(0.5, 0.5);
const FAIR = doubt(3, 3);
const POOR = doubt(30, 20);
const STEP_NS = 100_000_000;

/** Feed doubts ten times a second, from one second on. */
function styles(doubts: readonly Doubt[], certainty = new Certainty()): string[] {
  return doubts.map((one, index) => certainty.take(one, 1e9 + index * STEP_NS));
}
const many = (one: Doubt, count: number): Doubt[] => Array.from({ length: count }, () => one);

describe("the style that a doubt allows", () => {
  test.each([
    [1.49, 1.49, "locked"],
    [1.5, 0.1, "ghost"],
    [0.1, 1.5, "ghost"],
    [7.9, 7.9, "ghost"],
    [8, 0.1, "guide"],
    [0.1, 8, "guide"],
    [Number.POSITIVE_INFINITY, 0, "guide"],
    [Number.NaN, 0, "guide"],
  ])("%d m and %d degrees: %s", (place_m, heading_deg, style) => {
    expect(styleAt(doubt(place_m, heading_deg))).toBe(style);
  });

  test("a heading that nothing has told is guided, however small its number", () => {
    const covariance = new Array(36).fill(0);
    const pose = { covariance, headingKnown: false } as unknown as CameraPose;
    expect(styleAt(doubtOf(pose))).toBe("guide");
    expect(styleAt(doubtOf({ ...pose, headingKnown: true }))).toBe("locked");
  });

  test("the place counts along its worst direction, off the axes too", () => {
    const covariance = new Array(36).fill(0);
    Object.assign(covariance, { 0: 2, 1: 1.9, 6: 1.9, 7: 2 });
    const pose = { covariance, headingKnown: true } as unknown as CameraPose;
    expect(doubtOf(pose).place_m).toBeCloseTo(Math.sqrt(3.9), 9);
  });
});

describe("from picture to picture", () => {
  test("the first picture decides at once", () => {
    expect(styles([SURE])).toEqual(["locked"]);
    expect(styles([FAIR])).toEqual(["ghost"]);
    expect(styles([POOR])).toEqual(["guide"]);
  });

  test("worse comes at once", () => {
    expect(styles([SURE, FAIR, POOR])).toEqual(["locked", "ghost", "guide"]);
  });

  test("better comes after a second, over both steps together", () => {
    const seen = styles([POOR, ...many(SURE, 12)]);
    expect(seen.indexOf("locked")).toBe(1 + DWELL_NS / STEP_NS);
    expect(new Set(seen.slice(0, seen.indexOf("locked")))).toEqual(new Set(["guide"]));
  });

  test("one worse picture and the second begins anew", () => {
    const seen = styles([FAIR, ...many(SURE, 8), FAIR, ...many(SURE, 8)]);
    expect(seen).not.toContain("locked");
  });

  test("a little below the limit is enough to stay and not enough to come", () => {
    const { place_m, heading_rad } = LIMITS.locked;
    const near = { place_m: 0.95 * place_m, heading_rad: 0.95 * heading_rad };
    expect(new Set(styles([SURE, ...many(near, 30)]))).toEqual(new Set(["locked"]));
    expect(new Set(styles([FAIR, ...many(near, 30)]))).toEqual(new Set(["ghost"]));
  });

  test("a jump in time begins anew", () => {
    const certainty = new Certainty();
    expect(certainty.take(POOR, 5e9)).toBe("guide");
    expect(certainty.take(SURE, 1e9)).toBe("locked");
    expect(certainty.take(POOR, 2e9)).toBe("guide");
    expect(certainty.take(SURE, 9e9)).toBe("locked");
  });

  test("whatever the doubts are, locked is within its limit, and comes after a second within it", () => {
    let entries = 0;
    forSeeds(20, (random) => {
      let [place_m, heading_deg] = [1.4, 1.0];
      const doubts = Array.from({ length: 400 }, () => {
        place_m = Math.abs(place_m + random.between(-0.1, 0.1));
        heading_deg = Math.abs(heading_deg + random.between(-0.1, 0.1));
        return doubt(place_m, heading_deg);
      });
      const seen = styles(doubts);
      const allowed = doubts.map((one) => styleAt(one));
      seen.forEach((style, index) => {
        if (style !== "locked") return;
        expect(allowed[index]).toBe("locked");
        if (index === 0 || seen[index - 1] === "locked") return;
        entries += 1;
        expect(new Set(allowed.slice(index - DWELL_NS / STEP_NS, index + 1))).toEqual(new Set(["locked"]));
      });
    });
    expect(entries).toBeGreaterThan(5);
  });
});
