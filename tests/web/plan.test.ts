/** The plan of the site: what is drawn where, and the way in words. */

import {
  conePath,
  contains,
  frameOf,
  middleOf,
  outlinePath,
  type Place,
  wayTo,
  wayWords,
  within,
} from "../../web/src/plan";

const SQUARE: readonly Place[] = [
  [-10, -5],
  [10, -5],
  [10, 5],
  [-10, 5],
];

test("a frame holds all outlines and a margin, its middle is theirs", () => {
  const frame = frameOf([SQUARE, [[30, 0]]]);
  expect(frame).toEqual({ west: -22, south: -17, east: 42, north: 17 });
  expect(middleOf(frame)).toEqual([10, 0]);
  expect(frameOf([])).toEqual({ west: -50, south: -50, east: 50, north: 50 });
});

test("north is up: the y of a path grows to the south", () => {
  expect(outlinePath(SQUARE)).toBe("M-10.0,5.0L10.0,5.0L10.0,-5.0L-10.0,-5.0Z");
});

test("the cone opens about the heading", () => {
  expect(conePath([0, 0], Math.PI / 2, Math.PI / 4)).toMatch(/^M0.0,-?0.0L18.4,-18.4A26,26 0 0 1 18.4,18.4Z$/);
  expect(conePath([0, 0], 0, 3)).toContain("0 1 1");
});

test("who is outside is shown at the rim", () => {
  const frame = frameOf([SQUARE]);
  expect(within([500, 1], frame)).toEqual([22, 1]);
  expect(within([3, -900], frame)).toEqual([3, -17]);
});

test("inside and outside are told apart", () => {
  expect(contains(SQUARE, [9, 4])).toBe(true);
  expect(contains(SQUARE, [11, 0])).toBe(false);
  expect(contains([], [0, 0])).toBe(false);
});

test.each([
  [0, 0, "20 m straight ahead."],
  [Math.PI / 2, -90, "20 m to your left."],
  [Math.PI, 180, "20 m behind you."],
  [-Math.PI / 4, 45, "20 m ahead, to your right."],
  [(-3 * Math.PI) / 4, 135, "20 m behind you, to the right."],
])("looking to %d the square in the north is turned to by %d degrees", (heading_rad, turn_deg, words) => {
  const way = wayTo([0, -20], heading_rad, [0, 0]);
  expect(way.distance_m).toBe(20);
  expect(Math.abs(((way.turn_rad ?? 9) * 180) / Math.PI)).toBeCloseTo(Math.abs(turn_deg), 6);
  expect(Math.sign(Math.round(way.turn_rad ?? 9))).toBe(
    turn_deg === 180 ? Math.sign(way.turn_rad ?? 9) : Math.sign(turn_deg),
  );
  expect(wayWords(way)).toBe(`The middle of the square is ${words}`);
});

test("without a heading the way is told by the compass", () => {
  expect(wayWords(wayTo([-30, 0], null, [0, 0]))).toBe("The middle of the square is 30 m to the east.");
});
