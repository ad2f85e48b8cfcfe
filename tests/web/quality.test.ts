/** How much is drawn: up while there is time, down when it is too slow, and no flapping between both. */

import { EFFORTS, Quality } from "../../web/src/quality";

function draw(quality: Quality, took_ms: number, count: number, from_ms = 0): number {
  let now = from_ms;
  for (let i = 0; i < count; i++) {
    now += 40;
    quality.drawn(took_ms, now);
  }
  return now;
}

const names = EFFORTS.map(({ name }) => name);

test("it starts low without a graphics card and high with one", () => {
  expect(new Quality(true).effort.name).toBe("first paint");
  expect(new Quality(false).effort.name).toBe("full");
});

test("with time to spare it goes up to the top, one step at a time", () => {
  const quality = new Quality(true);
  const seen = [quality.effort.name];
  for (let i = 0; i < 100; i++) {
    quality.drawn(5, i * 40);
    if (seen.at(-1) !== quality.effort.name) seen.push(quality.effort.name);
  }
  expect(seen).toEqual(names);
});

test("it goes down when a step is too slow, and stays where it fits", () => {
  const quality = new Quality(false);
  const cost = (name: string): number => (name === "full" ? 60 : name === "surfaces" ? 45 : 25);
  for (let i = 0; i < 200; i++) quality.drawn(cost(quality.effort.name), i * 40);
  expect(quality.effort.name).toBe("soft edges");
  expect(quality.usual_ms).toBe(25);
});

test("a very slow step is left two at a time, and a single slow picture changes nothing", () => {
  const quality = new Quality(false);
  draw(quality, 200, 8);
  expect(quality.effort.name).toBe(names.at(-3));
  const steady = new Quality(false);
  draw(steady, 20, 8);
  steady.drawn(500, 400);
  draw(steady, 20, 8, 400);
  expect(steady.effort.name).toBe("full");
});

test("a step that was too slow is tried again, more and more seldom", () => {
  const quality = new Quality(true);
  const tries: number[] = [];
  for (let now = 0; now < 400_000; now += 40)
    if (quality.drawn(quality.effort.name === "shadows" ? 50 : 10, now) && quality.effort.name === "shadows")
      tries.push(now);
  expect(tries.length).toBeGreaterThan(2);
  expect(tries.length).toBeLessThan(7);
  const waits = tries.slice(1).map((now, i) => now - (tries[i] ?? 0));
  for (const [i, wait] of waits.slice(1).entries()) expect(wait).toBeGreaterThan(1.8 * (waits[i] ?? 0));
});

test("a fixed step stays; one that there is not is none", () => {
  const quality = Quality.fixed("shadows");
  if (!quality) throw new Error("no such step");
  draw(quality, 500, 50);
  expect(quality.effort.name).toBe("shadows");
  expect(Quality.fixed("everything")).toBeNull();
});

test("each step up draws at least what the one below draws", () => {
  for (const [i, effort] of EFFORTS.slice(1).entries()) {
    const below = EFFORTS[i];
    if (!below) throw new Error("no step below");
    expect(effort.fineness).toBeGreaterThanOrEqual(below.fineness);
    for (const key of ["shadows", "occluders", "soft"] as const)
      expect(Number(effort[key])).toBeGreaterThanOrEqual(Number(below[key]));
    for (const key of ["plain", "finest"] as const) expect(Number(effort[key])).toBeLessThanOrEqual(Number(below[key]));
  }
});
