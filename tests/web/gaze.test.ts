/** With a walker: out of their eyes as they look, and behind them without being swung about. */

import { length, minus, type Place, type Wxyz } from "../../web/src/beside/between";
import { Escort, eyeOfWalker, headingOfWalker, mixed, rowsOf } from "../../web/src/beside/gaze";
import { Glide } from "../../web/src/beside/glide";
import { Looks } from "../../web/src/beside/looks";
import type { Shown } from "../../web/src/beside/poses";
import { Rest } from "../../web/src/beside/rest";
import { Trail } from "../../web/src/beside/trail";
import { eyeOf, poseOf } from "../../web/src/browse/eye";
import type { PoseMessage } from "../../web/src/wire";
import { forSeeds } from "./random";

/** Return a walker who looks in a heading, clockwise from north. */
function walker(heading_rad: number, e = 0): Place {
  const yaw_rad = Math.PI / 2 - heading_rad;
  const wxyz: Wxyz = [Math.cos(yaw_rad / 2), 0, 0, Math.sin(yaw_rad / 2)];
  return { p_site_body_m: [e, 2, 1.7], wxyz_site_body: wxyz };
}

/** Where nothing stands. */
const open = (): number => Number.POSITIVE_INFINITY;

test("the eye of a walker stands where they stand and looks where they look", () => {
  for (const heading_rad of [0, 1, 3, 6]) {
    const eye = eyeOfWalker(walker(heading_rad));
    expect(eye.place_site_m).toEqual([0, 2, 1.7]);
    expect(eye.heading_rad).toBeCloseTo(heading_rad, 9);
    expect(eye.pitch_rad).toBeCloseTo(0, 9);
    expect(headingOfWalker(walker(heading_rad))).toBeCloseTo(heading_rad, 9);
  }
  const down: Wxyz = [Math.cos(0.15), 0, Math.sin(0.15), 0]; // about the left: nose down
  expect(eyeOfWalker({ p_site_body_m: [0, 0, 0], wxyz_site_body: down }).pitch_rad).toBeCloseTo(-0.3, 9);
});

test("the first column of a rotation is where the body faces", () => {
  const [[forward_e], [forward_n], [forward_u]] = rowsOf([Math.SQRT1_2, 0, 0, Math.SQRT1_2]);
  expect(length(minus([forward_e, forward_n, forward_u], [0, 1, 0]))).toBeLessThan(1e-9);
});

test("who follows comes from where they were, and then stays as far behind", () => {
  const from = { place_site_m: [50, 50, 20], heading_rad: 1, pitch_rad: -0.5 } as const;
  const escort = new Escort("follow", from, 1000, false, open);
  expect(escort.at(walker(0), 1000)).toEqual(from);
  expect(escort.isThere(1000)).toBe(false);
  let before = escort.at(walker(0), 1000);
  for (let now_ms = 1016; now_ms < 4000; now_ms += 16) {
    const eye = escort.at(walker(0), now_ms);
    expect(length(minus(eye.place_site_m, before.place_site_m))).toBeLessThan(3);
    before = eye;
  }
  expect(escort.isThere(4000)).toBe(true);
  expect(before.place_site_m[1]).toBeLessThan(2 - 3);
  expect(before.heading_rad).toBeCloseTo(0, 6);
  // a head that turns away at once swings the camera about by and by
  const turned = escort.at(walker(Math.PI / 2), 4016);
  expect(length(minus(turned.place_site_m, before.place_site_m))).toBeLessThan(0.4);
});

test("who follows a walker is never behind a wall that stands behind them", () => {
  forSeeds(40, (random) => {
    let wall_m = Number.POSITIVE_INFINITY;
    const start = { place_site_m: [0, 2, 1.7], heading_rad: 0, pitch_rad: 0 } as const;
    const escort = new Escort("follow", start, 0, true, () => wall_m);
    const armAt = (now_ms: number): number => {
      const at = escort.at(walker(0), now_ms).place_site_m;
      return length(minus(at, walker(0).p_site_body_m));
    };
    const whole_m = armAt(16);
    expect(whole_m).toBeGreaterThan(5);
    wall_m = random.between(0.1, 5);
    const close_m = armAt(32);
    expect(close_m).toBeLessThan(wall_m);
    expect(close_m).toBeGreaterThan(0);
    expect(escort.isAtRest).toBe(true);
    // out again by and by, and all the way
    wall_m = Number.POSITIVE_INFINITY;
    let before_m = close_m;
    for (let now_ms = 48; now_ms < 8000; now_ms += 16) {
      const arm_m = armAt(now_ms);
      expect(arm_m).toBeGreaterThanOrEqual(before_m);
      expect(arm_m - before_m).toBeLessThan(0.3);
      before_m = arm_m;
    }
    expect(before_m).toBeCloseTo(whole_m, 6);
    expect(escort.isAtRest).toBe(true);
  });
});

test("who wants little motion is there at once", () => {
  const from = { place_site_m: [50, 50, 20], heading_rad: 1, pitch_rad: -0.5 } as const;
  const escort = new Escort("eyes", from, 0, true, open);
  expect(escort.at(walker(2), 0).place_site_m).toEqual([0, 2, 1.7]);
});

test("between two eyes the heading takes the shorter way", () => {
  const at = (heading_rad: number) => ({ place_site_m: [0, 0, 0], heading_rad, pitch_rad: 0 }) as const;
  expect(mixed(at(6), at(0.2), 0.5).heading_rad).toBeCloseTo(6 + (0.2 + 2 * Math.PI - 6) / 2, 9);
});

test("others come to where they say they are, and who has gone is gone", () => {
  const glide = new Glide();
  const told = (e: number) => [
    { number: 4, eye: eyeOf(poseOf({ place_site_m: [e, 0, 2], heading_rad: 1, pitch_rad: 0 })) },
  ];
  glide.at(told(0), 0);
  let last = 0;
  for (let now_ms = 16; now_ms < 2000; now_ms += 16) {
    const e = glide.at(told(3), now_ms).get(4)?.place_site_m[0] ?? Number.NaN;
    expect(e).toBeGreaterThanOrEqual(last);
    expect(e).toBeLessThanOrEqual(3);
    last = e;
  }
  expect(glide.isAtRest(told(3))).toBe(true);
  expect(glide.isAtRest(told(0))).toBe(false);
  expect(glide.at(told(90), 2016).get(4)?.place_site_m[0]).toBe(90);
  expect(glide.at([], 2032).size).toBe(0);
});

test("a look is told at most four times a second, and every two seconds where nothing changes", () => {
  const looks = new Looks();
  let told = 0;
  for (let now_ms = 0; now_ms < 10_000; now_ms += 16)
    told += Number(looks.isDue({ place_site_m: [now_ms / 1000, 0, 0], heading_rad: 0, pitch_rad: 0 }, now_ms));
  expect(told).toBeGreaterThan(30);
  expect(told).toBeLessThanOrEqual(40);
  const still = { place_site_m: [9, 9, 9], heading_rad: 0, pitch_rad: 0 } as const;
  const again = Array.from({ length: 625 }, (_, i) => looks.isDue(still, 20_000 + 16 * i)).filter(Boolean);
  expect(again.length).toBe(5);
  looks.forget();
  expect(looks.isDue(still, 30_001)).toBe(true);
});

test("who trembles is seen to stand, and who walks off is where they are at once", () => {
  forSeeds(20, (random) => {
    const rest = new Rest();
    const told = { motionModel: "P0R0", headingKnown: true, variance: [0.04, 0.04] } as unknown as PoseMessage;
    const shown = (e: number, heading_rad = 0): Shown => ({ ...walker(heading_rad, e), t_ns: 0, age_ms: 0, told });
    rest.at(shown(0), 0);
    expect(rest.moves).toBe(true);
    const places = new Set<number>();
    for (let now_ms = 16; now_ms < 3000; now_ms += 16) {
      const place = rest.at(shown(random.between(-0.004, 0.004), random.between(-0.001, 0.001)), now_ms);
      if (now_ms > 600) places.add(place.p_site_body_m[0]);
    }
    expect(rest.moves).toBe(false);
    expect(places.size).toBe(1);
    // nobody is shown away from where they are: as slowly as they go
    for (let i = 1, e = 0; i < 200; i++) {
      e += random.between(0, 0.012);
      const place = rest.at(shown(e), 3000 + 33 * i);
      expect(Math.abs(place.p_site_body_m[0] - e)).toBeLessThan(0.025);
    }
    expect(rest.moves).toBe(true);
    const now_ms = 3000 + 33 * 200 + 2000;
    for (const t_ms of [now_ms, now_ms + 2000]) rest.at(shown(9), t_ms);
    expect(rest.moves).toBe(false);
    rest.at({ ...shown(9), told: { ...told, motionModel: "P1R1" } as PoseMessage }, now_ms + 2016);
    expect(rest.moves).toBe(true);
  });
});

test("a trail leads over every place that is a step on, forgets the oldest, and does not cross a jump", () => {
  const trail = new Trail(10);
  expect(trail.add([0, 0, 0], "P0R0")).toBeNull();
  expect(trail.add([0.1, 0, 0], "P0R0")).toBeNull();
  expect(trail.add([0.3, 0, 0], "P1R0")).toEqual({ slot: 0, from: [0, 0, 0], to: [0.3, 0, 0], motionModel: "P1R0" });
  expect(trail.add([50, 0, 0], "P1R0")).toBeNull();
  expect(trail.pieces).toBe(1);
  forSeeds(1, (random) => {
    let e = 50;
    for (let i = 0; i < 25; i++) {
      e += random.between(0.3, 1);
      trail.add([e, 0, 0], null);
    }
  });
  expect(trail.pieces).toBe(10);
  expect(trail.add([100, 0, 0], null)?.slot ?? null).toBeNull();
  trail.clear();
  expect(trail.pieces).toBe(0);
});
