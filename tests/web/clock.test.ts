/** A device's clock beside the server's. */

import { clockOff, clockWords } from "../../web/src/clock";
import { PoseAge } from "../../web/src/playback";

const NOON = "Sun, 21 Jun 2026 12:00:00 GMT";
const noon_ms = Date.UTC(2026, 5, 21, 12);

test("a clock that is nearly right is right", () => {
  expect(clockOff(NOON, noon_ms + 90_000)).toBe(0);
  expect(clockOff(null, noon_ms)).toBe(0);
  expect(clockOff("yesterday, or so", noon_ms)).toBe(0);
  expect(clockWords(0)).toBeNull();
});

test("one that is wrong by an hour is put right, and said", () => {
  const off_s = clockOff(NOON, noon_ms - 3_600_000);
  expect(off_s).toBe(3600);
  expect(clockWords(off_s)).toBe("This device's clock is 60 minutes behind: the sun is drawn by the rig's clock.");
  expect(clockWords(-2 * 3600)).toContain("2 hours ahead");
  expect(clockWords(40 * 86_400)).toContain("40 days behind");
});

test("the pose's age comes back after the rig's clock has jumped, either way", () => {
  for (const jump_ms of [3_600_000, -3_600_000]) {
    const age = new PoseAge();
    for (let i = 0; i < 10; i++) age.drawn((1e9 + i * 40) * 1e6, i * 40 + 20);
    for (let i = 10; i < 14; i++) age.drawn((1e9 + jump_ms + i * 40) * 1e6, i * 40 + 20);
    expect(age.at(14 * 40)).toBeLessThan(200);
  }
});
