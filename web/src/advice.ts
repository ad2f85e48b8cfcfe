/** What the tracker knows of the visitor, in plain words, and what would make it better. Pure. */

import type { Style } from "./certainty";
import { headingOf } from "./frames";
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
  return isTruth && sigma_m < EXACT_M ? "exactly" : `to about ${metresText(sigma_m)}`;
}

/** Return which way the visitor looks, and how well that is known. */
export function headingWords({ T_site_cam, covariance, headingKnown, isTruth }: CameraPose): string {
  if (!headingKnown) return "not known yet";
  const point = compassPoint(headingOf(T_site_cam));
  const sigma_rad = headingSigma(covariance);
  return isTruth && sigma_rad < EXACT_RAD ? `${point}, exactly` : `${point}, to ${degreesText(sigma_rad)}`;
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
  if (nearEdge && kind === "live") return "Mind your step: there is an edge near you. The square steps back here.";
  if (nearEdge) return "Near an edge: the square steps back here.";
  if (style === "locked" || !pose.headingKnown) return null;
  const [place_m, heading_rad] = [horizontalSigma(pose.covariance), headingSigma(pose.covariance)];
  if (style === "ghost") {
    const off = metresText(Math.hypot(place_m, USUAL_M * heading_rad));
    if (kind === "replay") return `An outline: the square may be ${off} aside here.`;
    return `An outline: the square may be ${off} aside. Align it, or walk on until I am surer.`;
  }
  const turned = heading_rad / (8 * DEGREE) > place_m / 8;
  if (kind === "replay")
    return `Not drawn: the tracker does not know well enough where the visitor ${turned ? "looks" : "is"}.`;
  if (turned)
    return "I do not know well enough where you look: walk a few steps, or press Align and point out a landmark.";
  return "I do not know well enough where you are: go where the sky is open, or press Align and show me on the plan.";
}
