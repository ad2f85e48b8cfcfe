/** Laws of rigid transforms, and that the axes are those of CONVENTIONS.md. */

import {
  column,
  compose,
  headingOf,
  invertRigid,
  isRigid,
  type Matrix4,
  T_cam_view,
  T_gltf_site,
  transform,
  viewFromCam,
} from "../../web/src/frames";
import { forSeeds } from "./random";

const IDENTITY: Matrix4 = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function expectClose(got: readonly number[], wanted: readonly number[]): void {
  expect(got.length).toBe(wanted.length);
  got.forEach((value, i) => {
    expect(value).toBeCloseTo(wanted[i] ?? Number.NaN, 9);
  });
}

test("a transform after its inverse changes nothing, on either side", () => {
  forSeeds(50, (random) => {
    const T_a_b = random.rigid(100);
    expectClose(compose(T_a_b, invertRigid(T_a_b)), IDENTITY);
    expectClose(compose(invertRigid(T_a_b), T_a_b), IDENTITY);
    expectClose(invertRigid(invertRigid(T_a_b)), T_a_b);
  });
});

test("composing transforms is transforming twice, and is associative", () => {
  forSeeds(50, (random) => {
    const [T_a_b, T_b_c, T_c_d] = [random.rigid(10), random.rigid(10), random.rigid(10)];
    const p_c = random.point(10);
    expectClose(transform(compose(T_a_b, T_b_c), p_c), transform(T_a_b, transform(T_b_c, p_c)));
    expectClose(compose(compose(T_a_b, T_b_c), T_c_d), compose(T_a_b, compose(T_b_c, T_c_d)));
  });
});

test("rigid transforms keep distances and are known as rigid; stretched, mirrored or broken ones are not", () => {
  forSeeds(50, (random) => {
    const T = random.rigid(10);
    const [p, q] = [random.point(10), random.point(10)];
    const [a, b] = [transform(T, p), transform(T, q)];
    expect(Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2])).toBeCloseTo(
      Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]),
      9,
    );
    expect(isRigid(T)).toBe(true);
    const entry = random.below(12);
    const isRotation = entry % 4 !== 3;
    const changed = T.map((value, i) => (i === entry ? value + 0.5 : value));
    expect(isRigid(changed)).toBe(!isRotation);
    expect(isRigid(T.map((value, i) => (i % 4 === 0 && i < 12 ? -value : value)))).toBe(false);
    expect(isRigid(T.map((value, i) => (i === entry ? Number.NaN : value)))).toBe(false);
    expect(isRigid(T.slice(1))).toBe(false);
  });
});

test("east stays east, up becomes y, and north becomes minus z in three.js", () => {
  expectClose(transform(T_gltf_site, [1, 0, 0]), [1, 0, 0]);
  expectClose(transform(T_gltf_site, [0, 1, 0]), [0, 0, -1]);
  expectClose(transform(T_gltf_site, [0, 0, 1]), [0, 1, 0]);
  expect(isRigid(T_gltf_site)).toBe(true);
  expect(isRigid(T_cam_view)).toBe(true);
});

test("three.js's camera stands where the optical one stands and looks where it looks", () => {
  forSeeds(50, (random) => {
    const T_site_cam = random.rigid(50);
    const T_gltf_view = viewFromCam(T_site_cam);
    const ahead_m = random.between(1, 50);
    const seen_site = transform(T_site_cam, [0, 0, ahead_m]);
    expectClose(transform(T_gltf_view, [0, 0, -ahead_m]), transform(T_gltf_site, seen_site));
    const below_site = transform(T_site_cam, [0, 1, 0]);
    expectClose(transform(T_gltf_view, [0, -1, 0]), transform(T_gltf_site, below_site));
  });
});

test.each([
  ["north", [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1], 0],
  ["east", [0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1], Math.PI / 2],
  ["south", [-1, 0, 0, 0, 0, 0, -1, 0, 0, -1, 0, 0, 0, 0, 0, 1], Math.PI],
  ["west", [0, 0, -1, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1], 1.5 * Math.PI],
])("a camera that looks %s has that heading", (_name, T_site_cam, heading_rad) => {
  expect(isRigid(T_site_cam)).toBe(true);
  expect(headingOf(T_site_cam)).toBeCloseTo(heading_rad, 12);
});

test("columns are the axes of b in a", () => {
  forSeeds(20, (random) => {
    const T_a_b = random.rigid(0);
    expectClose(column(T_a_b, 0), transform(T_a_b, [1, 0, 0]));
    expectClose(column(T_a_b, 1), transform(T_a_b, [0, 1, 0]));
    expectClose(column(T_a_b, 2), transform(T_a_b, [0, 0, 1]));
  });
});
