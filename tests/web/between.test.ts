/** The pose between two poses: through both, never wild, and hardly beyond the newest. */

import {
  angleBetween,
  back,
  between,
  HORIZON_NS,
  length,
  minus,
  onward,
  plus,
  scaled,
  slerp,
  type Told,
  turned,
  type Wxyz,
} from "../../web/src/beside/between";
import { forSeeds, type Random } from "./random";

function rotation(random: Random): Wxyz {
  const [w = 1, x = 0, y = 0, z = 0] = [0, 0, 0, 0].map(() => random.between(-1, 1));
  const long = Math.hypot(w, x, y, z) || 1;
  return [w / long, x / long, y / long, z / long];
}

function told(random: Random, t_ns: number): Told {
  return {
    t_ns,
    p_site_body_m: random.point(5),
    wxyz_site_body: rotation(random),
    v_site_m_s: random.point(random.below(2) === 0 ? 2 : 200),
  };
}

function pair(random: Random): [Told, Told] {
  const t_ns = random.between(0, 1e12);
  return [told(random, t_ns), told(random, t_ns + random.between(1e6, 5e8))];
}

test("the curve goes through both poses", () => {
  forSeeds(200, (random) => {
    const [a, b] = pair(random);
    for (const end of [a, b]) {
      const place = between(a, b, end.t_ns);
      expect(length(minus(place.p_site_body_m, end.p_site_body_m))).toBeLessThan(1e-9);
      expect(angleBetween(place.wxyz_site_body, end.wxyz_site_body)).toBeLessThan(1e-6);
    }
  });
});

test("no pace is more than twice the even one, and no place further off the straight way than a quarter of it", () => {
  forSeeds(200, (random) => {
    const [a, b] = pair(random);
    const way = minus(b.p_site_body_m, a.p_site_body_m);
    const steps = 200;
    let last = a.p_site_body_m;
    for (let step = 1; step <= steps; step++) {
      const u = step / steps;
      const place = between(a, b, a.t_ns + u * (b.t_ns - a.t_ns)).p_site_body_m;
      expect(length(minus(place, last))).toBeLessThanOrEqual((2 * length(way)) / steps + 1e-9);
      expect(length(minus(place, plus(a.p_site_body_m, scaled(way, u))))).toBeLessThanOrEqual(length(way) / 4 + 1e-9);
      last = place;
    }
  });
});

test("where the told velocities are those of the way, the curve has them", () => {
  const walk = (t_s: number): Told => ({
    t_ns: t_s * 1e9,
    p_site_body_m: [Math.sin(t_s), t_s, t_s ** 2 / 2],
    wxyz_site_body: [1, 0, 0, 0],
    v_site_m_s: [Math.cos(t_s), 1, t_s],
  });
  for (let t_s = 0.5; t_s < 0.6; t_s += 0.01) {
    const place = between(walk(0.5), walk(0.6), t_s * 1e9).p_site_body_m;
    expect(length(minus(place, walk(t_s).p_site_body_m))).toBeLessThan(1e-6);
  }
});

test("after the newest pose the way on is short, begins at the told pace and ends where it began", () => {
  forSeeds(100, (random) => {
    const newest = told(random, random.between(0, 1e12));
    const ahead = (share: number): number =>
      length(minus(onward(newest, newest.t_ns + share * HORIZON_NS).p_site_body_m, newest.p_site_body_m));
    const reach_m = length(newest.v_site_m_s) * HORIZON_NS * 1e-9;
    for (let share = 0; share < 1.5; share += 0.01) expect(ahead(share)).toBeLessThanOrEqual((4 / 27) * reach_m + 1e-9);
    expect(ahead(0.001)).toBeCloseTo(0.001 * reach_m, 3);
    expect(ahead(1)).toBeLessThan(1e-9);
    expect(onward(newest, newest.t_ns - 1).p_site_body_m).toEqual(newest.p_site_body_m);
  });
});

test("a turn takes the shorter way at an even pace", () => {
  forSeeds(200, (random) => {
    const [a, b] = [rotation(random), rotation(random)];
    const whole = angleBetween(a, b);
    expect(whole).toBeLessThanOrEqual(Math.PI + 1e-9);
    for (const share of [0.25, 0.5, 0.75]) expect(angleBetween(a, slerp(a, b, share))).toBeCloseTo(share * whole, 5);
  });
  const near: Wxyz = [Math.cos(1e-6), Math.sin(1e-6), 0, 0];
  expect(slerp([1, 0, 0, 0], near, 0.5)[1]).toBeCloseTo(5e-7, 9);
});

test("a turn and then back is none", () => {
  forSeeds(50, (random) => {
    const a = rotation(random);
    expect(turned(a, back(a))[0]).toBeCloseTo(1, 9);
  });
});
