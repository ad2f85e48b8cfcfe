/**
 * The virtual square as others may use it who put something into it: walkers, for one.
 *
 * `Stage` (stage.ts) is the world; `main.ts` makes it and hands it to whoever joins. What is drawn is drawn on demand: a
 * picture comes when somebody has asked for one, or while a `Turn` says that it is not at rest.
 *
 * Frames: all that is given and taken is in `site` (x east, y north, z up, metres; CONVENTIONS.md); three.js's own world is
 * `gltf`, and `guests` is turned between them, so that a child's position is (e, n, u).
 */

import type { Group, PerspectiveCamera } from "three";
import type { Matrix4, Vector3 } from "../frames";
import type { Eye } from "./eye";

/** Called before each picture; returns whether it wants another one after it. */
export type Turn = (now_ms: number) => boolean;

/** Tells where the camera is in the picture that is drawn next, `T_site_cam`; null leaves it where it is. */
export type Leader = (now_ms: number) => Matrix4 | null;

export interface World {
  /** Put your own things in here, site axes. They are lit by the sun of the model that is shown, and outlive a change of model. */
  readonly guests: Group;
  /** Read it, to project with; it is moved by `lead` and `go` alone. Its axes are three.js's, in the gltf frame. */
  readonly camera: PerspectiveCamera;
  readonly canvas: HTMLCanvasElement;
  readonly eye: Eye;
  /** Ask for a picture. */
  ask(): void;
  /** Something may have changed: the turns are taken, and a picture comes where one says that it moves. */
  look(): void;
  /** Return how far one sees from a place towards another, metres; infinite where nothing stands between. */
  reach(from: Vector3, to: Vector3): number;
  /** Take part in each picture; returns what ends it. */
  eachPicture(turn: Turn): () => void;
  /**
   * Let the camera follow, until another leader is given, the visitor moves by themselves, or goes elsewhere: `released` is
   * called then. Null lets go. Give poses that are smooth already; ask for pictures while they change.
   */
  lead(leader: Leader | null, released?: () => void): void;
  /** Fly there; at once where the visitor wants little motion. */
  go(eye: Eye): void;
}
