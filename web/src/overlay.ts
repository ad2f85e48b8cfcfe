/** What is laid over each picture: the style by the tracker's doubt, held back where visitors must see the ground. Pure. */

import { Certainty, type Doubt, doubtOf, type Style } from "./certainty";
import { Edges } from "./edges";
import type { Matrix4 } from "./frames";
import { Safety } from "./safety";
import type { CameraPose, FrameMessage } from "./wire";

/** How the model is laid over the picture. */
export interface Laying {
  /** How much of the model covers the picture, 0 to 1, before the visitor's own wish. */
  readonly share: number;
  /** How much of its outlines is drawn, 0 to 1. */
  readonly outline: number;
  /** The ground is left clear up to this distance, metres. */
  readonly clear_m: number;
  /** The eyes above that ground, metres. */
  readonly eye_m: number;
}

export interface Overlay {
  /** `none` while there is no pose. */
  readonly style: Style | "none";
  readonly laying: Laying;
  readonly nearEdge: boolean;
  readonly doubt: Doubt | null;
  /** Where the model is drawn from; null where it is not drawn. */
  readonly T_site_cam: Matrix4 | null;
}

const SHARES: Readonly<Record<Style, readonly [share: number, outline: number]>> = {
  locked: [1, 0],
  ghost: [0.42, 0.85],
  guide: [0, 0],
};
/** Eyes this near to the ground, or below it, are a height that is wrong. */
const LOWEST_EYE_M = 0.5;

/** Works it out from picture to picture. */
export class Overlays {
  /** Of the site; none are known until they are loaded. */
  edges = new Edges([], []);
  eyeHeight_m = 1.65;
  /** Whether a visitor is putting the square right: who does that must see it, however far off it is. */
  aligning = false;
  private readonly certainty = new Certainty();
  private readonly safety = new Safety();

  /** Take the next picture with the pose of its own capture, or null for one without. */
  take(message: FrameMessage, pose: CameraPose | null): Overlay {
    if (message.soughtJustBefore) this.certainty.reset();
    if (pose === null) return NOTHING;
    const doubt = doubtOf(pose);
    const sure = this.certainty.take(doubt, pose.t_ns);
    const style = sure === "guide" && this.aligning && pose.headingKnown ? "ghost" : sure;
    const [e_m = 0, n_m = 0, u_m = 0] = [3, 7, 11].map((index) => pose.T_site_cam[index]);
    const edge_m = this.edges.distance(e_m, n_m);
    const { clear_m, share, nearEdge } = this.safety.take(pose.t_ns, pose.v_site_m_s, edge_m, doubt.place_m);
    const [cover, outline] = SHARES[style];
    const ground_m = this.edges.groundAt(e_m, n_m);
    const eye_m = ground_m === null ? this.eyeHeight_m : Math.max(LOWEST_EYE_M, u_m - ground_m);
    return {
      style,
      laying: { share: cover * share, outline: outline * share, clear_m, eye_m },
      nearEdge,
      doubt,
      T_site_cam: style === "guide" ? null : pose.T_site_cam,
    };
  }
}

/** While the square is dragged: both it and what is behind it are to be seen. */
export const GHOST: Laying = { share: SHARES.ghost[0], outline: SHARES.ghost[1], clear_m: 0, eye_m: 1.65 };

/** Return a laying through which what stands today can be found. */
export function seenThrough({ share, outline, ...rest }: Laying): Laying {
  return { ...rest, share: 0.3 * share, outline: 0.6 * Math.max(share, outline) };
}

/** Before the first pose. */
export const NOTHING: Overlay = {
  style: "none",
  laying: { share: 0, outline: 0, clear_m: 0, eye_m: 1.65 },
  nearEdge: false,
  doubt: null,
  T_site_cam: null,
};
