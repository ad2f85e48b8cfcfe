/**
 * The calibrated camera: points to pixels of the original picture and back, with OpenCV's three lens models.
 *
 * Pixel (0, 0) is the CENTRE of the top-left pixel, so a picture covers -0.5 to width - 0.5. "Ideal" coordinates are
 * x/z and y/z of the camera frame, "bent" ones what the lens makes of them, both without unit. No three.js in here.
 */

import type { Vector3 } from "./frames";

export type LensModel = "none" | "plumb_bob" | "rational_polynomial" | "equidistant";
export type Pair = readonly [number, number];

export interface Lens {
  readonly width_px: number;
  readonly height_px: number;
  readonly fx_px: number;
  readonly fy_px: number;
  readonly cx_px: number;
  readonly cy_px: number;
  readonly model: LensModel;
  /** plumb_bob: k1 k2 p1 p2 k3; rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6; equidistant: k1 k2 k3 k4; then zeros. */
  readonly coefficients: readonly number[];
}

/** Ideal coordinates past this (84 degrees off the axis) are outside what a plane can show. */
const WIDEST = 10;
const NEWTON_STEPS = 40;
const NEWTON_DONE = 1e-13;
/** Of the search that Newton's starts from: a thousandth of the domain is near enough. */
const HALVINGS = 12;

/** Return the bent radius over the ideal one, `r` from the axis; tangential terms aside. */
function radialGain(lens: Lens, r2: number): number {
  const [k1 = 0, k2 = 0, , , k3 = 0, k4 = 0, k5 = 0, k6 = 0] = lens.coefficients;
  if (lens.model === "none") return 1;
  if (lens.model === "equidistant") {
    const [e1 = 0, e2 = 0, e3 = 0, e4 = 0] = lens.coefficients;
    const r = Math.sqrt(r2);
    if (r < 1e-9) return 1;
    const theta = Math.atan(r);
    const t2 = theta * theta;
    return (theta * (1 + t2 * (e1 + t2 * (e2 + t2 * (e3 + t2 * e4))))) / r;
  }
  const numerator = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return lens.model === "plumb_bob" ? numerator : numerator / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
}

/** Return what the lens makes of ideal coordinates. Reference: OpenCV, calib3d, `projectPoints` and `fisheye`. */
export function bend(lens: Lens, [x, y]: Pair): Pair {
  const r2 = x * x + y * y;
  const gain = radialGain(lens, r2);
  if (lens.model === "none" || lens.model === "equidistant") return [x * gain, y * gain];
  const [, , p1 = 0, p2 = 0] = lens.coefficients;
  return [x * gain + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * gain + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y];
}

/**
 * Return the ideal radius up to which the lens model is one to one.
 *
 * A polynomial lens folds back beyond its last calibrated ring, and would draw what lies behind the visitor's shoulder
 * into the middle of the picture: nothing is projected past this radius.
 */
export function domainRadius(lens: Lens): number {
  const step = 1e-3;
  let last = 0;
  for (let r = step; r < WIDEST; r += step * (1 + r)) {
    const bent = r * radialGain(lens, r * r);
    if (!(bent > last)) return r - step * (1 + r);
    last = bent;
  }
  return WIDEST;
}

/** Return the ideal coordinates that the lens bends to these, or null where none do. */
export function unbend(lens: Lens, bent: Pair, radius = domainRadius(lens)): Pair | null {
  if (lens.model === "none") return bent;
  let [x, y] = radialGuess(lens, bent, radius);
  for (let i = 0; i < NEWTON_STEPS; i++) {
    const [bx, by] = bend(lens, [x, y]);
    const dx = bx - bent[0];
    const dy = by - bent[1];
    if (Math.abs(dx) + Math.abs(dy) < NEWTON_DONE) return Math.hypot(x, y) <= radius ? [x, y] : null;
    [x, y] = newtonStep(lens, [x, y], [bx, by], [dx, dy], radius);
  }
  const [bx, by] = bend(lens, [x, y]);
  const close = Math.hypot(bx - bent[0], by - bent[1]) < 1e-9;
  return close && Math.hypot(x, y) <= radius ? [x, y] : null;
}

/** Return where `unbend` starts: exact but for the tangential terms, by halving, since radii only grow inside the domain. */
function radialGuess(lens: Lens, bent: Pair, radius: number): Pair {
  const wanted = Math.hypot(...bent);
  let [low, high] = [0, radius];
  for (let i = 0; i < HALVINGS; i++) {
    const middle = (low + high) / 2;
    if (middle * radialGain(lens, middle * middle) < wanted) low = middle;
    else high = middle;
  }
  const scale = wanted > 0 ? high / wanted : 0;
  return [bent[0] * scale, bent[1] * scale];
}

/** One step with differences for derivatives, kept inside the domain so that it cannot jump past the fold. */
function newtonStep(lens: Lens, [x, y]: Pair, [bx, by]: Pair, [dx, dy]: Pair, radius: number): Pair {
  const h = 1e-7;
  const [xx, xy] = bend(lens, [x + h, y]);
  const [yx, yy] = bend(lens, [x, y + h]);
  const [a, b, c, d] = [(xx - bx) / h, (yx - bx) / h, (xy - by) / h, (yy - by) / h];
  const determinant = a * d - b * c;
  if (Math.abs(determinant) < 1e-9) return [x * 0.9, y * 0.9];
  const nextX = x - (d * dx - b * dy) / determinant;
  const nextY = y - (a * dy - c * dx) / determinant;
  const shrink = Math.min(1, (radius * 1.001) / Math.hypot(nextX, nextY));
  return [nextX * shrink, nextY * shrink];
}

/** Return the pixel of the original picture where `p_cam` is seen; null behind the camera or outside the lens model. */
export function project(lens: Lens, p_cam: Vector3, radius = domainRadius(lens)): Pair | null {
  const [x, y, z] = p_cam;
  if (!(z > 1e-6)) return null;
  const ideal: Pair = [x / z, y / z];
  if (!(Math.hypot(...ideal) <= radius)) return null;
  const [bx, by] = bend(lens, ideal);
  return [lens.fx_px * bx + lens.cx_px, lens.fy_px * by + lens.cy_px];
}

/** Return the ideal coordinates seen at a pixel of the original picture, or null outside the lens model. */
export function idealAt(lens: Lens, [u_px, v_px]: Pair, radius = domainRadius(lens)): Pair | null {
  return unbend(lens, [(u_px - lens.cx_px) / lens.fx_px, (v_px - lens.cy_px) / lens.fy_px], radius);
}

/** Whether two pictures were taken through the same lens, so that the lookup made for one serves the other. */
export function sameLens(a: Lens, b: Lens): boolean {
  const numbers = (lens: Lens): number[] => [
    lens.width_px,
    lens.height_px,
    lens.fx_px,
    lens.fy_px,
    lens.cx_px,
    lens.cy_px,
    ...lens.coefficients,
  ];
  const ours = numbers(a);
  const theirs = numbers(b);
  return a.model === b.model && ours.length === theirs.length && ours.every((value, i) => value === theirs[i]);
}
