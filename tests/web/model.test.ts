/** What is ground and what is building: the model's own word, on the node or on one that it is part of. */

import { isGround } from "../../web/src/model";

/** three.js itself stands where no test can import it by name. */
type Object3D = Parameters<typeof isGround>[0];

function node(role: unknown, parent: Object3D | null = null): Object3D {
  return { userData: role === undefined ? {} : { role }, parent } as unknown as Object3D;
}

test("a node is ground where it says so", () => {
  expect(isGround(node("ground"))).toBe(true);
  expect(isGround(node("building"))).toBe(false);
  expect(isGround(node(undefined))).toBe(false);
  expect(isGround(node(true))).toBe(false);
});

test("a part of the ground is ground: a node of several materials becomes a group of meshes", () => {
  const group = node("ground", node(undefined));
  expect(isGround(node(undefined, group))).toBe(true);
  expect(isGround(node(undefined, node(undefined, group)))).toBe(true);
  expect(isGround(node(undefined, node("building", node(undefined))))).toBe(false);
});
