/** Walking: along walls and never through them, up stairs and never down from a height, the same way each time. */

import { BODY_M, Ground } from "../../web/src/browse/ground";
import { type Intent, STILL } from "../../web/src/browse/intent";
import { type Post, postIn } from "../../web/src/browse/post";
import { isAtRest, STRIDE_M, standing, type Walker, walk } from "../../web/src/browse/walker";
import type { Triangle } from "../../web/src/edges";
import type { Vector3 } from "../../web/src/frames";
import type { Place } from "../../web/src/plan";
import { forSeeds, type Random } from "./random";

const EYES_M = 1.65;
const AHEAD: Intent = { ...STILL, ahead: 1 };
const EAST = Math.PI / 2;

/** A rectangle that rises to the east. */
function floor([west, south]: Place, [east, north]: Place, z = 0, rise = 0): Triangle[] {
  const at = (e: number, n: number): Vector3 => [e, n, z + rise * (e - west)];
  const [a, b, c, d] = [at(west, south), at(east, south), at(east, north), at(west, north)];
  return [
    [a, b, c],
    [a, c, d],
  ];
}

/** All places on the way of some steps of a sixtieth of a second. */
function walked(from: Walker, ground: Ground, intent: Intent, heading_rad: number, steps: number): Walker[] {
  const path = [from];
  for (let i = 0; i < steps; i++) path.push(walk(path.at(-1) ?? from, intent, heading_rad, ground, EYES_M, 1 / 60));
  return path;
}

function start(e = 0, n = 0, z = 0): Walker {
  return standing([e, n, z], EYES_M);
}

function end(path: readonly Walker[]): Walker {
  const last = path.at(-1);
  if (!last) throw new Error("a path has a start");
  return last;
}

/** Rooms with doors: squares of 4 m with some of their common walls gone; a body keeps clear of what is left. */
function maze(random: Random): { ground: Ground; isWall: (a: Vector3, b: Vector3) => boolean } {
  const side = 4;
  const triangles: Triangle[] = [];
  const walls: { readonly e: number; readonly n: number; readonly isEastern: boolean }[] = [];
  for (let i = 0; i < 6; i++) {
    for (let j = 0; j < 6; j++) {
      const [e, n] = [i * side, j * side];
      const low: Place = [e + BODY_M, n + BODY_M];
      const high: Place = [e + side - BODY_M, n + side - BODY_M];
      triangles.push(...floor(low, high));
      for (const isEastern of [true, false]) {
        const isOpen = random.between(0, 1) < 0.6 && (isEastern ? i : j) < 5;
        if (!isOpen) walls.push({ e, n, isEastern });
        else if (isEastern) triangles.push(...floor([high[0], low[1]], [high[0] + 2 * BODY_M, high[1]]));
        else triangles.push(...floor([low[0], high[1]], [high[0], high[1] + 2 * BODY_M]));
      }
    }
  }
  const isWall = (a: Vector3, b: Vector3): boolean =>
    walls.some(({ e, n, isEastern }) => {
      const [line, from, axis, other] = isEastern ? ([e + side, n, 0, 1] as const) : ([n + side, e, 1, 0] as const);
      if (a[axis] < line === b[axis] < line) return false;
      const share = (line - a[axis]) / (b[axis] - a[axis]);
      const at = a[other] + share * (b[other] - a[other]);
      return at > from && at < from + side;
    });
  return { ground: new Ground(triangles), isWall };
}

test("on level ground one walks where one looks, at a walking pace, and runs faster", () => {
  const ground = new Ground(floor([-50, -50], [50, 50]));
  const { feet_site_m, eyes_m } = end(walked(start(), ground, AHEAD, EAST, 120));
  expect(feet_site_m[0]).toBeGreaterThan(3);
  expect(feet_site_m[0]).toBeLessThan(4);
  expect(feet_site_m[1]).toBeCloseTo(0, 6);
  expect(eyes_m).toBeCloseTo(EYES_M, 6);
  const ran = end(walked(start(), ground, { ...AHEAD, hurry: true }, EAST, 120));
  expect(ran.feet_site_m[0]).toBeGreaterThan(2 * feet_site_m[0]);
  const aside = end(walked(start(), ground, { ...STILL, right: 1 }, 0, 60));
  expect(aside.feet_site_m[0]).toBeGreaterThan(1);
});

test("aslant one is no faster than straight on", () => {
  const ground = new Ground(floor([-50, -50], [50, 50]));
  const far = (intent: Intent): number => Math.hypot(...end(walked(start(), ground, intent, 0.3, 90)).feet_site_m);
  expect(far({ ...STILL, ahead: 1, right: 1 })).toBeCloseTo(far(AHEAD), 6);
});

test("the same start and intents give the same path", () => {
  forSeeds(5, (random) => {
    const { ground } = maze(random);
    const heading_rad = random.between(0, 6);
    expect(walked(start(2, 2), ground, AHEAD, heading_rad, 200)).toEqual(
      walked(start(2, 2), ground, AHEAD, heading_rad, 200),
    );
  });
});

test("through no wall, whatever is wanted and however long the steps are", () => {
  forSeeds(30, (random) => {
    const { ground, isWall } = maze(random);
    let walker = start(2, 2);
    let farthest = 0;
    for (let i = 0; i < 400; i++) {
      const intent: Intent = {
        ...STILL,
        ahead: random.between(-1, 1),
        right: random.between(-1, 1),
        hurry: random.below(2) === 1,
      };
      const heading_rad = random.between(0, 2 * Math.PI) + Math.floor(i / 40);
      const next = walk(
        walker,
        { ...intent, ahead: Math.abs(intent.ahead) },
        heading_rad,
        ground,
        EYES_M,
        random.between(0, 0.5),
      );
      const [e, n, z] = next.feet_site_m;
      if (isWall(walker.feet_site_m, next.feet_site_m)) throw new Error(`through a wall at ${e}, ${n}`);
      expect(ground.heightAt([e, n], z - 1e-6, z + 1e-6)).not.toBeNull();
      walker = next;
      farthest = Math.max(farthest, Math.hypot(e - 2, n - 2));
    }
    expect(farthest).toBeGreaterThan(0.5);
  });
});

test("along a wall one slides, into a corner one comes to rest", () => {
  const ground = new Ground(floor([-10, -10], [10, 10]));
  const along = end(walked(start(9, -9), ground, AHEAD, 0.6, 240)).feet_site_m;
  expect(along[0]).toBeGreaterThan(10 - STRIDE_M);
  expect(along[1]).toBeGreaterThan(-5);
  const corner = walked(start(9, 9), ground, AHEAD, Math.PI / 4, 240);
  const [before, after] = [corner.at(-20), corner.at(-1)];
  expect(after?.feet_site_m).toEqual(before?.feet_site_m);
  expect(isAtRest(end(walked(end(corner), ground, STILL, 0, 60)), EYES_M)).toBe(true);
});

test("stairs, which are slopes, are climbed, with the eyes behind the feet by little", () => {
  const ground = new Ground([
    ...floor([-5, -2], [0, 2]),
    ...floor([0, -2], [4, 2], 0, 0.5),
    ...floor([4, -2], [9, 2], 2),
  ]);
  const path = walked(start(-1), ground, AHEAD, EAST, 260);
  expect(end(path).feet_site_m[2]).toBeCloseTo(2, 6);
  for (const { eyes_m, feet_site_m } of path) {
    expect(Math.abs(eyes_m - feet_site_m[2] - EYES_M)).toBeLessThan(0.25);
  }
});

test("nobody falls from a height nor steps up one, but takes a kerb", () => {
  const high = new Ground([...floor([-5, -5], [0, 5], 1), ...floor([0, -5], [5, 5], 0)]);
  expect(end(walked(start(-2, 0, 1), high, AHEAD, EAST, 200)).feet_site_m).toEqual([
    expect.any(Number),
    expect.any(Number),
    1,
  ]);
  expect(end(walked(start(2, 0, 0), high, AHEAD, -EAST, 200)).feet_site_m[2]).toBe(0);
  const kerb = new Ground([...floor([-5, -5], [0, 5], 0.2), ...floor([0, -5], [5, 5], 0)]);
  expect(end(walked(start(-2, 0, 0.2), kerb, AHEAD, EAST, 200)).feet_site_m[0]).toBeGreaterThan(2);
});

test("a column is walked around, its lintel is walked under, a block that ends at the knee is not in the way", () => {
  const post = (bottom_m: number, top_m: number): Post => ({ e_m: 2, n_m: 0, radius_m: 0.5, bottom_m, top_m });
  const over = (posts: readonly Post[]): readonly Walker[] =>
    walked(start(0, 0.2), new Ground(floor([-9, -9], [9, 9]), posts), AHEAD, EAST, 180);
  const around = over([post(0, 8)]);
  for (const { feet_site_m } of around)
    expect(Math.hypot(feet_site_m[0] - 2, feet_site_m[1])).toBeGreaterThanOrEqual(0.5 + BODY_M - 1e-9);
  expect(end(around).feet_site_m[0]).toBeGreaterThan(2.5);
  expect(end(over([post(3, 8)])).feet_site_m[1]).toBeCloseTo(0.2, 6);
  expect(end(over([post(0, 0.3)])).feet_site_m[1]).toBeCloseTo(0.2, 6);
});

test("the nearest place to stand is found from anywhere, and is one", () => {
  forSeeds(20, (random) => {
    const ground = new Ground([...floor([-9, -9], [-3, 9]), ...floor([3, -9], [9, 9], 2)]);
    const [e, n] = [random.between(-60, 60), random.between(-60, 60)];
    const place = ground.nearest([e, n]);
    if (!place) throw new Error("there is ground");
    expect(ground.heightAt([place[0], place[1]], -1, 5)).toBeCloseTo(place[2], 6);
    const outside = Math.max(0, Math.abs(e) - 9, 3 - Math.abs(e));
    expect(Math.hypot(place[0] - e, place[1] - n)).toBeLessThan(
      Math.hypot(outside, Math.max(0, Math.abs(n) - 9)) + 0.6,
    );
  });
  expect(new Ground([]).nearest([0, 0])).toBeNull();
});

test("a column is a post, a wall, a roof and a kerb are none", () => {
  expect(postIn([1, 2, 0], [2, 3, 8])).toEqual({ e_m: 1.5, n_m: 2.5, radius_m: 0.4, bottom_m: 0, top_m: 8 });
  expect(postIn([0, 0, 0], [9, 0.5, 8])).toBeNull();
  expect(postIn([0, 0, 6], [4, 4, 7])).toBeNull();
  expect(postIn([0, 0, 0], [0.3, 0.3, 0.2])).toBeNull();
});
