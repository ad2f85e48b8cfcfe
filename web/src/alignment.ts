/**
 * Alignment by the visitor: what a tap may mean, what is sent to the rig, and what it has brought, in words. Pure.
 *
 * A landmark that is tapped, and a point of the model that is dragged to where it belongs, are the same to the tracker: this
 * direction is that point.
 */

import type { Doubt } from "./certainty";
import { compose, invertRigid, type Matrix4, transform, type Vector3 } from "./frames";
import { say } from "./language/speech";
import { idealAt, type Lens, type Pair, project } from "./lens";
import type { Landmark } from "./site";
import { degreesText, metresText } from "./words";

/** What is sent to the rig, as `server/messages.py` reads it. */
export type Alignment =
  | {
      readonly kind: "tap";
      readonly frame_id: number;
      readonly place_px: Pair;
      readonly sigma_px: number;
      readonly point_site_m: Vector3;
    }
  | { readonly kind: "here"; readonly e_m: number; readonly n_m: number; readonly sigma_m: number }
  | { readonly kind: "undo" };

/** A landmark that a tap may mean. */
export interface Candidate {
  readonly landmark: Landmark;
  /** How far from the tap it is thought to be seen, pixels; null where it is not thought to be in sight. */
  readonly off_px: number | null;
  readonly distance_m: number | null;
}

/** How well a pointer hits what is aimed at, one sigma, pixels of the page. */
const FINGER_PX = 8;
const MOUSE_PX = 3;
/** No lens and no eye are better than this, pixels of the picture. */
const LEAST_PX = 1.5;

/** Return one sigma of a tap in pixels of the picture, of which `scale` make one of the page. */
export function tapSigma(pointerType: string, scale: number): number {
  return Math.min(500, Math.max(LEAST_PX, scale * (pointerType === "mouse" ? MOUSE_PX : FINGER_PX)));
}

/** Return one sigma of a place that is tapped on a plan of which a pixel of the page is so many metres. */
export function hereSigma(pointerType: string, metresPerPixel: number): number {
  return Math.min(100, Math.max(0.7, metresPerPixel * (pointerType === "mouse" ? MOUSE_PX : FINGER_PX)));
}

/** Return all landmarks, those first that are thought to be seen nearest to the tap; without a pose in their own order. */
export function candidates(
  landmarks: readonly Landmark[],
  tap_px: Pair,
  lens: Lens,
  T_site_cam: Matrix4 | null,
): readonly Candidate[] {
  if (T_site_cam === null) return landmarks.map((landmark) => ({ landmark, off_px: null, distance_m: null }));
  const T_cam_site = invertRigid(T_site_cam);
  const found = landmarks.map((landmark): Candidate => {
    const p_cam = transform(T_cam_site, landmark.point_site_m);
    const seen = project(lens, p_cam);
    const distance_m = Math.hypot(...p_cam);
    return { landmark, off_px: seen && Math.hypot(seen[0] - tap_px[0], seen[1] - tap_px[1]), distance_m };
  });
  const order = ({ off_px }: Candidate): number => off_px ?? Number.POSITIVE_INFINITY;
  return found.sort((a, b) => compare(order(a), order(b)) || compare(a.distance_m ?? 0, b.distance_m ?? 0));
}

/** Infinities are equal to one another, which their difference does not tell. */
function compare(a: number, b: number): number {
  return a < b ? -1 : a > b ? 1 : 0;
}

/** Return the unit vector, site axes, in which a pixel of the picture is seen; null outside the lens model. */
export function sightOf(lens: Lens, T_site_cam: Matrix4, place_px: Pair): Vector3 | null {
  const ideal = idealAt(lens, place_px);
  if (ideal === null) return null;
  const [x, y] = ideal;
  const length = Math.hypot(x, y, 1);
  const eye = transform(T_site_cam, [0, 0, 0]);
  const at = transform(T_site_cam, [x / length, y / length, 1 / length]);
  return [at[0] - eye[0], at[1] - eye[1], at[2] - eye[2]];
}

/** Return the pose turned about the upright through the camera, so that what was seen at one pixel is seen at the other's bearing. */
export function draggedPose(lens: Lens, T_site_cam: Matrix4, from_px: Pair, to_px: Pair): Matrix4 {
  const [from, to] = [sightOf(lens, T_site_cam, from_px), sightOf(lens, T_site_cam, to_px)];
  if (from === null || to === null) return T_site_cam;
  const turn_rad = Math.atan2(from[1], from[0]) - Math.atan2(to[1], to[0]);
  const [c, s] = [Math.cos(turn_rad), Math.sin(turn_rad)];
  const [e = 0, n = 0] = [T_site_cam[3], T_site_cam[7]];
  const about: Matrix4 = [c, -s, 0, e - c * e + s * n, s, c, 0, n - s * e - c * n, 0, 0, 1, 0, 0, 0, 0, 1];
  return compose(about, T_site_cam);
}

/** A better sigma is one below this share of what it was. */
const BETTER = 0.9;

/** Return what an alignment has brought, in words, from the doubt before and after it. */
export function improvementWords(before: Doubt, after: Doubt): string {
  const told: string[] = [];
  if (after.heading_rad < BETTER * before.heading_rad)
    told.push(
      Number.isFinite(before.heading_rad)
        ? say("align.better_heading_was", {
            now: degreesText(after.heading_rad),
            before: degreesText(before.heading_rad),
          })
        : say("align.better_heading", { now: degreesText(after.heading_rad) }),
    );
  if (after.place_m < BETTER * before.place_m)
    told.push(
      Number.isFinite(before.place_m)
        ? say("align.better_place_was", { now: metresText(after.place_m), before: metresText(before.place_m) })
        : say("align.better_place", { now: metresText(after.place_m) }),
    );
  if (told.length > 0) return say("align.better", { what: told.join(", ") });
  return say("align.little");
}

/** So many landmarks, spread as far as this, tell place and direction. */
const ENOUGH = 3;
const SPREAD_RAD = Math.PI / 2;

/** Return what to do next, by the bearings of the landmarks that were pointed out so far. */
export function adviceFor(bearings_rad: readonly number[]): string {
  if (bearings_rad.length === 0) return say("align.first");
  if (bearings_rad.length >= ENOUGH && spreadOf(bearings_rad) >= SPREAD_RAD) return say("align.enough");
  if (spreadOf(bearings_rad) < SPREAD_RAD) return say("align.turn");
  return say("align.one_more");
}

/** Return the smallest angle that holds all bearings, radians. */
export function spreadOf(bearings_rad: readonly number[]): number {
  const whole = 2 * Math.PI;
  const sorted = bearings_rad.map((angle) => ((angle % whole) + whole) % whole).sort((a, b) => a - b);
  const [first] = sorted;
  if (first === undefined) return 0;
  const gaps = sorted.map((angle, index) => (sorted[index + 1] ?? first + whole) - angle);
  return whole - Math.max(...gaps);
}
