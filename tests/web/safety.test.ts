/** Where edges are, and what is left of the overlay near them and while walking. */

import { Edges, type Triangle } from "../../web/src/edges";
import type { Vector3 } from "../../web/src/frames";
import { Safety } from "../../web/src/safety";

/** A level rectangle, or a sloping one, as two triangles. */
function sheet(e0: number, e1: number, n0: number, n1: number, z0: number, z1 = z0): Triangle[] {
  const [a, b, c, d]: Vector3[] = [
    [e0, n0, z0],
    [e1, n0, z1],
    [e1, n1, z1],
    [e0, n1, z0],
  ];
  return [
    [a, b, c],
    [a, c, d],
  ] as Triangle[];
}

describe("edges", () => {
  test("in the middle of level ground there is none, and at its end there is a drop", () => {
    const edges = new Edges(sheet(-20, 20, -20, 20, 0), []);
    expect(edges.distance(0, 0)).toBe(8);
    expect(edges.distance(17, 0)).toBeCloseTo(2.75, 1);
    expect(edges.groundAt(3, 4)).toBeCloseTo(0, 6);
    expect(edges.groundAt(30, 0)).toBeNull();
  });

  test("an end where a wall stands is no drop", () => {
    const wall = sheet(20.25, 21.25, -20, 20, 3);
    const edges = new Edges(sheet(-20, 20, -20, 20, 0), wall);
    expect(edges.distance(18, 0)).toBe(8);
    expect(edges.distance(18, 18)).toBeLessThan(2.5);
  });

  test("a step up is told from both sides, a gentle slope is none and a stair's is", () => {
    const step = new Edges([...sheet(-20, 0, -20, 20, 0), ...sheet(0, 20, -20, 20, 0.4)], []);
    expect(step.distance(-3, 0)).toBeCloseTo(2.75, 1);
    expect(step.distance(3, 0)).toBeCloseTo(2.75, 1);
    const slope = [...sheet(-20, 0, -20, 20, 0), ...sheet(0, 20, -20, 20, 0, 3)];
    expect(new Edges(slope, []).distance(-1, 0)).toBe(8);
    const stair = [...sheet(-20, 0, -20, 20, 0), ...sheet(0, 2, -20, 20, 0, 1.2), ...sheet(2, 20, -20, 20, 1.2)];
    expect(new Edges(stair, []).distance(-2, 0)).toBeLessThan(2.5);
  });

  test("of two floors above one another the upper one counts", () => {
    const edges = new Edges([...sheet(-20, 20, -20, 20, 0), ...sheet(-5, 5, -5, 5, 2)], []);
    expect(edges.groundAt(0, 0)).toBeCloseTo(2, 6);
    expect(edges.distance(4, 0)).toBeLessThan(1.5);
  });

  test("without a surface nothing is known and nothing is near", () => {
    const edges = new Edges([], []);
    expect(edges.isEmpty).toBe(true);
    expect(edges.distance(0, 0)).toBe(8);
  });
});

describe("what is left of the overlay", () => {
  const SECOND_NS = 1_000_000_000;
  const WALK: Vector3 = [1, 0.5, 0];
  const STAND: Vector3 = [0.05, 0, 0];

  test("who stands far from edges sees all of it", () => {
    expect(new Safety().take(0, STAND, 8, 0.5)).toEqual({ clear_m: 0, share: 1, nearEdge: false });
  });

  test("the ground is clear with the first step, and covered again within a second of standing", () => {
    const safety = new Safety();
    safety.take(0, STAND, 8, 0.5);
    expect(safety.take(SECOND_NS / 10, WALK, 8, 0.5).clear_m).toBe(5);
    const after = safety.take(SECOND_NS / 5, STAND, 8, 0.5).clear_m;
    expect(after).toBeGreaterThan(3);
    expect(after).toBeLessThan(5);
    expect(safety.take(SECOND_NS * 1.2, STAND, 8, 0.5).clear_m).toBe(0);
  });

  test("a slow step between two others is not standing", () => {
    const safety = new Safety();
    safety.take(0, WALK, 8, 0.5);
    expect(safety.take(1, [0.3, 0, 0], 8, 0.5).clear_m).toBe(5);
    expect(new Safety().take(0, [0.3, 0, 0], 8, 0.5).clear_m).toBe(0);
  });

  test("the nearer an edge may be the less there is", () => {
    const share = (edge_m: number, doubt_m: number): number => new Safety().take(0, STAND, edge_m, doubt_m).share;
    expect(share(8, 0)).toBe(1);
    expect(share(2.5, 0)).toBeLessThan(share(3.2, 0));
    expect(share(2.5, 1)).toBeLessThan(share(2.5, 0));
    expect(share(1, 0)).toBeCloseTo(0.12, 6);
    expect(share(8, 1000)).toBe(1);
    expect(new Safety().take(0, STAND, 2, 0.2).nearEdge).toBe(true);
  });
});
