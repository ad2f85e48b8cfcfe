/**
 * Frames and rigid transforms, as in CONVENTIONS.md: `T_a_b` maps b coordinates to a, matrices are row major, metres.
 *
 * `site` is east north up; `gltf` (and three.js's world) is x east, y up, z south; `cam` is x right, y down, z forward;
 * `view` is three.js's camera: x right, y up, z backward. No three.js in here.
 */

/** 16 numbers, row major. */
export type Matrix4 = readonly number[];
export type Vector3 = readonly [number, number, number];

/** Maps site to gltf: (e, n, u) becomes (e, u, -n). */
export const T_gltf_site: Matrix4 = [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1];

/** Maps three.js's camera axes to the optical ones: y and z turn over. */
export const T_cam_view: Matrix4 = [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1];

function at(values: readonly number[], index: number): number {
  return values[index] ?? Number.NaN;
}

/** Return `T_a_c = T_a_b T_b_c`. */
export function compose(T_a_b: Matrix4, T_b_c: Matrix4): Matrix4 {
  const product: number[] = [];
  for (let row = 0; row < 4; row++) {
    for (let column = 0; column < 4; column++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += at(T_a_b, 4 * row + k) * at(T_b_c, 4 * k + column);
      product.push(sum);
    }
  }
  return product;
}

/** Return `T_b_a` of a rigid `T_a_b`: the rotation is transposed, not inverted. */
export function invertRigid(T_a_b: Matrix4): Matrix4 {
  const r = (row: number, column: number): number => at(T_a_b, 4 * row + column);
  const inverse: number[] = [];
  for (let row = 0; row < 3; row++) {
    const t = -(r(0, row) * r(0, 3) + r(1, row) * r(1, 3) + r(2, row) * r(2, 3));
    inverse.push(r(0, row), r(1, row), r(2, row), t);
  }
  return [...inverse, 0, 0, 0, 1];
}

/** Return `p_a = T_a_b p_b`. */
export function transform(T_a_b: Matrix4, p_b: Vector3): Vector3 {
  const row = (i: number): number =>
    at(T_a_b, i) * p_b[0] + at(T_a_b, i + 1) * p_b[1] + at(T_a_b, i + 2) * p_b[2] + at(T_a_b, i + 3);
  return [row(0), row(4), row(8)];
}

/** Return the world matrix of a three.js camera that stands where the optical camera stands. */
export function viewFromCam(T_site_cam: Matrix4): Matrix4 {
  return compose(compose(T_gltf_site, T_site_cam), T_cam_view);
}

/** Whether the matrix is a rigid motion within `tolerance` (rotation orthonormal and right-handed, last row 0 0 0 1). */
export function isRigid(T: Matrix4, tolerance = 1e-3): boolean {
  if (T.length !== 16 || !T.every(Number.isFinite)) return false;
  const near = (value: number, wanted: number): boolean => Math.abs(value - wanted) <= tolerance;
  if (!near(at(T, 12), 0) || !near(at(T, 13), 0) || !near(at(T, 14), 0) || !near(at(T, 15), 1)) return false;
  const x = column(T, 0);
  const y = column(T, 1);
  const z = column(T, 2);
  if (![x, y, z].every((axis) => near(dot(axis, axis), 1))) return false;
  return near(dot(x, y), 0) && near(dot(y, z), 0) && near(dot(z, x), 0) && dot(cross(x, y), z) > 0;
}

/** Return column `index` of the rotation: that axis of b, in a. */
export function column(T_a_b: Matrix4, index: 0 | 1 | 2): Vector3 {
  return [at(T_a_b, index), at(T_a_b, 4 + index), at(T_a_b, 8 + index)];
}

function dot(a: Vector3, b: Vector3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vector3, b: Vector3): Vector3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

/** Return which way the camera looks, clockwise from true north, [0, 2 pi). */
export function headingOf(T_site_cam: Matrix4): number {
  const [east, north] = column(T_site_cam, 2);
  const heading_rad = Math.atan2(east, north);
  return heading_rad < 0 ? heading_rad + 2 * Math.PI : heading_rad;
}
