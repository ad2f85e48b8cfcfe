/** The other viewers in the square: a sight in their colour with their number over it. three.js; site axes. */

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
} from "three";
import { type Eye, poseOf } from "../browse/eye";
import { colourOfViewer } from "./colours";

const SIGHT_M = 1.1;
const HALF_WIDTH = 0.5;
const HALF_HEIGHT = 0.32;
const EYE_M = 0.13;
const SIGN_M = 0.55;
const SIGN_UP_M = 0.55;
const SIGN_PX = 128;

export class Others {
  readonly group = new Group();
  private readonly marks = new Map<number, Group>();
  private readonly ball = new SphereGeometry(EYE_M, 20, 14);
  private readonly sight = sightOf();

  /** Show these, and nobody else. */
  show(eyes: ReadonlyMap<number, Eye>): void {
    for (const [number, mark] of this.marks) if (!eyes.has(number)) this.remove(number, mark);
    for (const [number, eye] of eyes) {
      const mark = this.marks.get(number) ?? this.make(number);
      const T = poseOf(eye);
      mark.matrix.set(...(T as Parameters<typeof mark.matrix.set>));
      mark.matrixWorldNeedsUpdate = true;
    }
  }

  dispose(): void {
    for (const [number, mark] of this.marks) this.remove(number, mark);
    for (const shape of [this.ball, this.sight.faces, this.sight.edges]) shape.dispose();
    this.group.removeFromParent();
  }

  private make(number: number): Group {
    const color = colourOfViewer(number);
    const mark = new Group();
    mark.matrixAutoUpdate = false;
    const plain = { color, fog: false, toneMapped: false };
    const veil = { ...plain, transparent: true, opacity: 0.25, depthWrite: false, side: DoubleSide };
    const sign = new Sprite(
      new SpriteMaterial({ map: signOf(number, color), depthWrite: false, fog: false, toneMapped: false }),
    );
    sign.scale.setScalar(SIGN_M);
    sign.position.y = -SIGN_UP_M; // down is y to a camera
    mark.add(
      new Mesh(this.ball, new MeshBasicMaterial(plain)),
      new Mesh(this.sight.faces, new MeshBasicMaterial(veil)),
      new LineSegments(this.sight.edges, new LineBasicMaterial(plain)),
      sign,
    );
    this.marks.set(number, mark);
    this.group.add(mark);
    return mark;
  }

  private remove(number: number, mark: Group): void {
    this.marks.delete(number);
    mark.removeFromParent();
    for (const part of mark.children) {
      if (part instanceof Sprite) part.material.map?.dispose();
      if (part instanceof Mesh || part instanceof LineSegments || part instanceof Sprite) part.material.dispose();
    }
  }
}

/** Return a pyramid from the eye along z, x to the right, y down. */
function sightOf(): { faces: BufferGeometry; edges: BufferGeometry } {
  const [x, y, z] = [SIGHT_M * HALF_WIDTH, SIGHT_M * HALF_HEIGHT, SIGHT_M];
  const places = new BufferAttribute(new Float32Array([0, 0, 0, -x, -y, z, x, -y, z, x, y, z, -x, y, z]), 3);
  return {
    faces: new BufferGeometry().setAttribute("position", places).setIndex([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1]),
    edges: new BufferGeometry()
      .setAttribute("position", places.clone())
      .setIndex([0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1]),
  };
}

/** Return a round sign with a number on it. */
function signOf(number: number, colour: string): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = SIGN_PX;
  const pen = canvas.getContext("2d");
  if (pen) {
    const middle = SIGN_PX / 2;
    pen.fillStyle = "#14110d";
    pen.strokeStyle = colour;
    pen.lineWidth = 10;
    pen.beginPath();
    pen.arc(middle, middle, middle - 8, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
    pen.fillStyle = "#f6efe2";
    pen.font = `600 ${number > 99 ? 44 : 64}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText(String(number), middle, middle + 4);
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}
