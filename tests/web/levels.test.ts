/** Levels of detail: chosen by distance, kept for a while, and only those that are there. */

import { bestOf, groupOf, levelAt } from "../../web/src/levels";

const REACH_M = [30, 80];

test("the level follows the distance: up to and with each reach", () => {
  expect([0, 30, 30.1, 80, 80.1, 1e6].map((distance) => levelAt(distance, REACH_M))).toEqual([0, 0, 1, 1, 2, 2]);
  expect(levelAt(500, [])).toBe(0);
});

test("walking to and fro over a border changes the level once", () => {
  const seen: number[] = [];
  let level: number | null = null;
  for (const distance of [31, 29.9, 30.1, 29.9, 30.1, 34.4, 29.9, 34.6, 30.1, 29.9]) {
    level = levelAt(distance, REACH_M, level);
    seen.push(level);
  }
  expect(seen).toEqual([1, 0, 0, 0, 0, 0, 0, 1, 1, 0]);
});

test("a leap is followed at once, however far", () => {
  expect(levelAt(500, REACH_M, 0)).toBe(2);
  expect(levelAt(0, REACH_M, 2)).toBe(0);
  expect(levelAt(85, REACH_M, 0)).toBe(1);
});

test("a level that has not come in is stood in for by a coarser one, else by what there is", () => {
  expect(bestOf(0, [2])).toBe(2);
  expect(bestOf(0, [2, 1])).toBe(1);
  expect(bestOf(1, [2, 0])).toBe(2);
  expect(bestOf(2, [2, 1, 0])).toBe(2);
  expect(bestOf(2, [0])).toBe(0);
  expect(bestOf(1, [])).toBeNull();
});

test("the parts of a monument change together, and a piece of ground alone", () => {
  expect(groupOf("basilica_stoa/roof", "basilica_stoa")).toBe("basilica_stoa");
  expect(groupOf("basilica_stoa/roof", null)).toBe("basilica_stoa");
  expect(groupOf("ground@1,-2", null)).toBe("ground@1,-2");
});
