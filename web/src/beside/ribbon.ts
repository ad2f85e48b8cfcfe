/** A walker's trail, drawn as a line a few pixels wide just over the ground. three.js; site axes. */

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Mesh,
  ShaderMaterial,
  Vector2,
  type WebGLRenderer,
} from "three";
import type { Vector3 } from "../frames";
import { colourOfMotion } from "./colours";
import { Trail } from "./trail";

/** Eight hundred metres. */
const PIECES = 4000;
const WIDTH_PX = 4.5;
const LIFT_M = 0.08;
/** Of a piece: at its beginning or its end, to its left or its right. */
const CORNERS: readonly (readonly [number, number])[] = [
  [0, 1],
  [0, -1],
  [1, 1],
  [1, -1],
];
const TRIANGLES = [0, 1, 2, 2, 1, 3];

/** Each piece is as wide and half as wide longer at both ends, in pixels; what of it is behind the eye is cut off. */
const VERTEX = /* glsl */ `
  attribute vec3 from; attribute vec3 to; attribute vec2 corner; attribute vec3 paint;
  uniform vec2 size; uniform float width;
  varying vec3 vPaint;
  void main() {
    vPaint = paint;
    vec4 a = modelViewMatrix * vec4(from, 1.0);
    vec4 b = modelViewMatrix * vec4(to, 1.0);
    float near = -0.5 * projectionMatrix[3][2] / projectionMatrix[2][2];
    if (a.z > near && b.z < near) a = mix(a, b, (near - a.z) / (b.z - a.z));
    else if (b.z > near && a.z < near) b = mix(b, a, (near - b.z) / (a.z - b.z));
    a = projectionMatrix * a;
    b = projectionMatrix * b;
    vec2 along = (b.xy / b.w - a.xy / a.w) * size;
    along /= max(length(along), 1e-6);
    gl_Position = corner.x < 0.5 ? a : b;
    vec2 aside = vec2(-along.y, along.x) * corner.y + along * (2.0 * corner.x - 1.0);
    gl_Position.xy += aside * width / size * gl_Position.w;
  }`;

const FRAGMENT = /* glsl */ `
  uniform float opacity;
  varying vec3 vPaint;
  void main() {
    gl_FragColor = vec4(vPaint, opacity);
    #include <colorspace_fragment>
  }`;

export class Ribbon {
  /** Plain triangles: copies of one piece take a processor without a graphics card a quarter of a millisecond each. */
  readonly line: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly trail = new Trail(PIECES);
  private readonly geometry = new BufferGeometry();

  constructor(private readonly eyeHeight_m: number) {
    const { geometry } = this;
    // all the room at once: a buffer that is made anew for each piece would never be given back
    for (const name of ["from", "to", "paint"])
      geometry.setAttribute(name, new BufferAttribute(new Float32Array(12 * PIECES), 3).setUsage(DynamicDrawUsage));
    const pieces = Array.from({ length: PIECES }, (_, slot) => slot);
    const corners = new Float32Array(pieces.flatMap(() => CORNERS.flat()));
    geometry.setAttribute("corner", new BufferAttribute(corners, 2));
    geometry.setIndex(pieces.flatMap((slot) => TRIANGLES.map((corner) => 4 * slot + corner)));
    geometry.setDrawRange(0, 0);
    const size = new Vector2();
    this.line = new Mesh(
      geometry,
      new ShaderMaterial({
        uniforms: { size: { value: size }, width: { value: WIDTH_PX }, opacity: { value: 0.9 } },
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        transparent: true,
        toneMapped: false,
      }),
    );
    this.line.onBeforeRender = (renderer: WebGLRenderer) => renderer.getSize(size);
    this.line.frustumCulled = false;
  }

  /** Go on to where the rig is; return whether there is a new piece. */
  add([e, n, u]: Vector3, motionModel: string | null): boolean {
    const piece = this.trail.add([e, n, u - this.eyeHeight_m + LIFT_M], motionModel);
    if (piece === null) return false;
    this.put("from", piece.slot, piece.from);
    this.put("to", piece.slot, piece.to);
    this.put("paint", piece.slot, colourOfMotion(motionModel).toArray());
    this.geometry.setDrawRange(0, TRIANGLES.length * this.trail.pieces);
    return true;
  }

  clear(): void {
    this.trail.clear();
    this.geometry.setDrawRange(0, 0);
  }

  dispose(): void {
    this.line.removeFromParent();
    this.geometry.dispose();
    this.line.material.dispose();
  }

  /** Give all corners of a piece the same three numbers, and have them alone sent to the graphics card. */
  private put(name: string, slot: number, three: readonly number[]): void {
    const attribute = this.geometry.getAttribute(name) as BufferAttribute;
    attribute.array.set([...three, ...three, ...three, ...three], 12 * slot);
    attribute.addUpdateRange(12 * slot, 12);
    attribute.needsUpdate = true;
  }
}
