/** A walker's trail, drawn as a line a few pixels wide just over the ground. three.js; site axes. */

import { type InterleavedBufferAttribute, Sphere, Vector3 as Vector } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Vector3 } from "../frames";
import { colourOfMotion } from "./colours";
import { Trail } from "./trail";

/** Eight hundred metres. */
const PIECES = 4000;
const WIDTH_PX = 4.5;
const LIFT_M = 0.08;

export class Ribbon {
  readonly line: LineSegments2;
  private readonly trail = new Trail(PIECES);
  private readonly geometry = new LineSegmentsGeometry();

  constructor(private readonly eyeHeight_m: number) {
    // all the room at once: a buffer that is made anew for each piece would never be given back
    this.geometry.setPositions(new Float32Array(6 * PIECES));
    this.geometry.setColors(new Float32Array(6 * PIECES));
    this.geometry.instanceCount = 0;
    this.geometry.boundingSphere = new Sphere(new Vector(), 1e5);
    this.line = new LineSegments2(
      this.geometry,
      new LineMaterial({
        linewidth: WIDTH_PX,
        vertexColors: true,
        transparent: true,
        opacity: 0.9,
        fog: false,
        toneMapped: false,
      }),
    );
    this.line.frustumCulled = false;
  }

  /** Go on to where the rig is; return whether there is a new piece. */
  add([e, n, u]: Vector3, motionModel: string | null): boolean {
    const piece = this.trail.add([e, n, u - this.eyeHeight_m + LIFT_M], motionModel);
    if (piece === null) return false;
    const colour = colourOfMotion(motionModel).toArray();
    put(this.geometry, "instanceStart", piece.slot, [...piece.from, ...piece.to]);
    put(this.geometry, "instanceColorStart", piece.slot, [...colour, ...colour]);
    this.geometry.instanceCount = this.trail.pieces;
    return true;
  }

  clear(): void {
    this.trail.clear();
    this.geometry.instanceCount = 0;
  }

  dispose(): void {
    this.line.removeFromParent();
    this.geometry.dispose();
    this.line.material.dispose();
  }
}

/** Put six numbers into the place of one piece, and have them alone sent to the graphics card. */
function put(geometry: LineSegmentsGeometry, name: string, slot: number, six: readonly number[]): void {
  const { data } = geometry.getAttribute(name) as InterleavedBufferAttribute;
  data.array.set(six, 6 * slot);
  data.addUpdateRange(6 * slot, 6);
  data.needsUpdate = true;
}
