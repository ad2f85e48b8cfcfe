/** What the tracker knows of the visitor, in plain words, and what would make it better. Pure. */

import type { Style } from "./certainty";
import { headingOf } from "./frames";
import { say } from "./language/speech";
import type { CameraPose } from "./wire";
import { compassPoint, degreesText, headingSigma, horizontalSigma, metresText } from "./words";

/** Ground truth as good as this is shown as the truth. */
const EXACT_M = 0.005;
const EXACT_RAD = 0.001;
/** A square that is looked at is so far away, usually. */
const USUAL_M = 30;
const DEGREE = Math.PI / 180;

/** Return how well the place is known. */
export function placeWords({ covariance, isTruth }: CameraPose): string {
  const sigma_m = horizontalSigma(covariance);
  return isTruth && sigma_m < EXACT_M ? say("hud.exactly") : say("hud.to_about", { length: metresText(sigma_m) });
}

/** Return which way the visitor looks, and how well that is known. */
export function headingWords({ T_site_cam, covariance, headingKnown, isTruth }: CameraPose): string {
  if (!headingKnown) return say("hud.unknown_yet");
  const point = compassPoint(headingOf(T_site_cam));
  const sigma_rad = headingSigma(covariance);
  if (isTruth && sigma_rad < EXACT_RAD) return say("hud.point_exactly", { point });
  return say("hud.point_to", { point, angle: degreesText(sigma_rad) });
}

export interface Shown {
  readonly style: Style | "none";
  readonly nearEdge: boolean;
  readonly pose: CameraPose | null;
  readonly kind: "live" | "replay";
  readonly aligning: boolean;
}

/** Return why the square is shown as it is and what to do about it, or null where it is as it should be. */
export function adviceOf({ style, nearEdge, pose, kind, aligning }: Shown): string | null {
  if (pose === null || style === "none" || aligning) return null;
  if (nearEdge && kind === "live") return say("advice.edge_live");
  if (nearEdge) return say("advice.edge");
  if (style === "locked" || !pose.headingKnown) return null;
  const [place_m, heading_rad] = [horizontalSigma(pose.covariance), headingSigma(pose.covariance)];
  if (style === "ghost") {
    const off = metresText(Math.hypot(place_m, USUAL_M * heading_rad));
    return say(kind === "replay" ? "advice.outline" : "advice.outline_live", { off });
  }
  const turned = heading_rad / (8 * DEGREE) > place_m / 8;
  if (kind === "replay") return say(turned ? "advice.heading" : "advice.place");
  return say(turned ? "advice.heading_live" : "advice.place_live");
}
