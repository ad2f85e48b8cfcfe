/** One button, and choosing by looking. */

import { APART_RAD, CHOOSES_AFTER_MS, Gaze } from "../../web/src/gaze";
import { LONG_MS, OneButton } from "../../web/src/press";

const DOWN = -0.8;

test("a short press is the next thing, a long one chooses, once", () => {
  const button = new OneButton();
  button.down(0);
  expect(button.held(200)).toBeNull();
  expect(button.up(250)).toBe("next");
  button.down(1000);
  expect(button.progress(1000 + LONG_MS / 2)).toBeCloseTo(0.5, 9);
  expect(button.held(1000 + LONG_MS)).toBe("choose");
  expect(button.held(1100 + LONG_MS)).toBeNull();
  expect(button.up(1200 + LONG_MS)).toBeNull();
});

test("a key that repeats is one press, a bounce is none, and a page that slept still sees the long one", () => {
  const button = new OneButton();
  for (const now of [0, 30, 60, 90]) button.down(now);
  expect(button.up(120)).toBe("next");
  expect(button.up(130)).toBeNull();
  button.down(200);
  expect(button.up(205)).toBeNull();
  button.down(300);
  expect(button.up(300 + LONG_MS)).toBe("choose");
});

function look(gaze: Gaze, pitch_rad: number, heading_rad: number, from_ms: number, for_ms: number) {
  const events = [];
  let now = from_ms;
  for (; now <= from_ms + for_ms; now += 50) {
    const { event } = gaze.take(pitch_rad, heading_rad, now);
    if (event !== null) events.push(event);
  }
  return { events, now };
}

test("a look at the feet opens, a look at a thing chooses it", () => {
  const gaze = new Gaze(3);
  const opened = look(gaze, DOWN, 1, 0, 1600);
  expect(opened.events).toEqual(["open"]);
  expect(gaze.places(1)).toBeNull();
  const up = look(gaze, 0, 6.2, opened.now, 200);
  expect(gaze.places(6.2)?.map((place) => place / APART_RAD)).toEqual([
    expect.closeTo(-1, 6),
    expect.closeTo(0, 6),
    expect.closeTo(1, 6),
  ]);
  const chosen = look(gaze, 0, 6.2 + APART_RAD - 2 * Math.PI, up.now, CHOOSES_AFTER_MS + 100);
  expect(chosen.events).toEqual([{ chosen: 2 }]);
  expect(gaze.isOpen).toBe(false);
});

test("a glance chooses nothing, a look far past puts the menu away", () => {
  const gaze = new Gaze(3);
  look(gaze, DOWN, 0, 0, 1600);
  let { now, events } = look(gaze, 0, 0, 1700, 900);
  ({ now, events } = look(gaze, 0, APART_RAD / 2, now, 400));
  expect(events).toEqual([]);
  ({ now, events } = look(gaze, 0, 0, now, 900));
  expect(events).toEqual([]);
  expect(look(gaze, 0, 2, now, 100).events).toEqual(["close"]);
});

test("looking down while walking opens nothing, and nobody is left with a menu", () => {
  const gaze = new Gaze(3);
  for (let i = 0; i < 10; i++) {
    expect(look(gaze, DOWN, 0, i * 2000, 1000).events).toEqual([]);
    expect(look(gaze, 0, 0, i * 2000 + 1050, 500).events).toEqual([]);
  }
  look(gaze, DOWN, 0, 100_000, 1600);
  look(gaze, 0, 0, 102_000, 100);
  expect(look(gaze, 0, 1.5 * APART_RAD, 102_200, 20_000).events).toEqual(["close"]);
});
