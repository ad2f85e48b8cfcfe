/** Keys, clocks and rates of the playback bar. */

import {
  clampSeek,
  clockText,
  estimatorChoices,
  FrameRate,
  neighbourSpeed,
  PoseAge,
  requestOfKey,
  SPEEDS,
} from "../../web/src/playback";
import { type Playback, parseSession } from "../../web/src/protocol";
import { forSeeds } from "./random";

const DURATION_S = 60;
const at = (position_s: number, more: Partial<Playback> = {}): Playback => ({
  playing: true,
  position_s,
  speed: 1,
  looping: false,
  ...more,
});

test("space turns playing into pausing and back", () => {
  expect(requestOfKey(" ", false, at(3), DURATION_S)).toEqual({ action: "pause", value: null });
  expect(requestOfKey(" ", false, at(3, { playing: false }), DURATION_S)).toEqual({ action: "play", value: null });
});

test("arrows step back and forth, further with shift, and never out of the walk", () => {
  forSeeds(100, (random) => {
    const position_s = random.between(0, DURATION_S);
    for (const shift of [false, true]) {
      const back = requestOfKey("ArrowLeft", shift, at(position_s), DURATION_S);
      const on = requestOfKey("ArrowRight", shift, at(position_s), DURATION_S);
      expect([back?.action, on?.action]).toEqual(["seek", "seek"]);
      const step_s = shift ? 15 : 5;
      expect(back?.value).toBe(Math.max(0, position_s - step_s));
      expect(on?.value).toBe(Math.min(DURATION_S, position_s + step_s));
    }
  });
  expect(requestOfKey("Home", false, at(30), DURATION_S)).toEqual({ action: "seek", value: 0 });
});

test("up is faster, down is slower, and each undoes the other between the ends", () => {
  SPEEDS.forEach((speed, i) => {
    expect(requestOfKey("ArrowUp", false, at(0, { speed }), DURATION_S)).toEqual({
      action: "speed",
      value: SPEEDS[i + 1] ?? speed,
    });
    if (i > 0) expect(neighbourSpeed(neighbourSpeed(speed, -1), 1)).toBe(speed);
    if (i < SPEEDS.length - 1) expect(neighbourSpeed(neighbourSpeed(speed, 1), -1)).toBe(speed);
  });
});

test("a speed that is not on offer goes to one that is", () => {
  forSeeds(50, (random) => {
    const speed = random.between(0.01, 20);
    expect(SPEEDS).toContain(neighbourSpeed(speed, 1));
    expect(SPEEDS).toContain(neighbourSpeed(speed, -1));
  });
});

test.each(["a", "Enter", "Tab", "Escape", "h", "End"])("%s is left to the page", (key) => {
  expect(requestOfKey(key, false, at(1), DURATION_S)).toBeNull();
});

test("a seek lands in the walk, and stays where it already is", () => {
  forSeeds(50, (random) => {
    const duration_s = random.between(0, 100);
    const place = clampSeek(random.between(-200, 200), duration_s);
    expect(place).toBeGreaterThanOrEqual(0);
    expect(place).toBeLessThanOrEqual(duration_s);
    expect(clampSeek(place, duration_s)).toBe(place);
  });
});

test.each([
  [-1, "0:00"],
  [0, "0:00"],
  [59.99, "0:59"],
  [60, "1:00"],
  [671.2, "11:11"],
])("%s seconds are %s", (seconds, text) => {
  expect(clockText(seconds)).toBe(text);
});

test("every estimator is offered once, those that cannot run with the reason", () => {
  const session = parseSession({
    name: "a",
    estimator: "truth",
    estimators: ["gps-imu/cmm", "truth"],
    unavailable: { "gps-imu/cmm": "This walk has no GPS.", precise: "This walk has no IMU." },
  });
  expect(estimatorChoices(session)).toEqual([
    { name: "gps-imu/cmm", reason: "This walk has no GPS." },
    { name: "truth", reason: null },
    { name: "precise", reason: "This walk has no IMU." },
  ]);
});

test("the rate counts pictures of the last two seconds and falls to nothing when they stop", () => {
  const rate = new FrameRate();
  expect(rate.at(0)).toBe(0);
  for (let i = 0; i <= 50; i++) rate.count(i * 100);
  expect(rate.at(5000)).toBeCloseTo(10, 6);
  expect(rate.at(7001)).toBe(0);
});

test("the age of a pose counts from the fastest message, adds what others were late by, and never is negative", () => {
  forSeeds(50, (random) => {
    const age = new PoseAge();
    expect(age.at(0)).toBeNull();
    const offset_ms = random.between(-1e6, 1e6);
    let fastest_ms = Number.POSITIVE_INFINITY;
    for (let i = 1; i <= 20; i++) {
      const delay_ms = random.between(1, 80);
      const arrived_ms = 100 * i + delay_ms;
      fastest_ms = Math.min(fastest_ms, delay_ms);
      age.drawn((100 * i + offset_ms) * 1e6, arrived_ms);
      const seen_ms = age.at(arrived_ms + 7) ?? Number.NaN;
      expect(seen_ms).toBeCloseTo(7 + delay_ms - fastest_ms, 3);
      expect(age.at(0)).toBeGreaterThanOrEqual(0);
    }
    age.reset();
    expect(age.at(1e9)).toBeNull();
  });
});
