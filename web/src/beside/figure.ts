/** A walker in the square: a draped figure, what its camera sees, and the ring that it is surely in. three.js; site axes. */

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  CircleGeometry,
  type Color,
  DoubleSide,
  Group,
  LatheGeometry,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  RingGeometry,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  SRGBColorSpace,
  Vector2,
} from "three";
import type { Lens } from "../lens";
import { colourOfMotion } from "./colours";
import { headingOfWalker } from "./gaze";
import type { Shown } from "./poses";

/** Radius of a draped body at heights that are shares of the eyes' height. */
const BODY: readonly (readonly [number, number])[] = [
  [0.0, 0.3],
  [0.012, 0.31],
  [0.3, 0.23],
  [0.52, 0.18],
  [0.62, 0.19],
  [0.76, 0.22],
  [0.83, 0.2],
  [0.87, 0.11],
  [0.895, 0.065],
  [0.93, 0.065],
];
const HEAD_M = 0.115;
const BODY_COLOUR = "#efe6d4";
const SIGHT_M = 3.2;
/** Over the ground, which is told to a few centimetres. */
const LIFT_M = 0.06;
/** So many sigmas hold 95 of 100 in the plane. */
const SURE = 2.45;
const LEAST_RING_M = 0.35;
/** Colours that tell something are as told: no light, haze or film changes them. */
const PLAIN = { transparent: true, depthWrite: false, fog: false, toneMapped: false } as const;
const BEACON_PX = 128;
/** Share of the picture's height, and how high over the eyes its tip is. */
const BEACON = 0.045;
const BEACON_UP_M = 0.45;
/** Who is nearer is seen without. */
const BEACON_FROM_M = 14;
/** Before a picture has told the lens. */
const USUAL = { right: 0.55, down: 0.41 };

export class Figure {
  readonly group = new Group();
  private readonly body = new Group();
  private readonly cloth = new MeshLambertMaterial({ color: BODY_COLOUR });
  private readonly rimPaint = new MeshBasicMaterial({ ...PLAIN, opacity: 0.9 });
  private readonly discPaint = new MeshBasicMaterial({ ...PLAIN, opacity: 0.22 });
  private readonly sightPaint = new MeshBasicMaterial({ ...PLAIN, opacity: 0.16, side: DoubleSide });
  private readonly edgePaint = new LineBasicMaterial({ ...PLAIN, opacity: 0.95 });
  private readonly sight = new Group();
  private readonly ring = new Group();
  private readonly beacon = beaconOf();

  constructor(private readonly eyeHeight_m: number) {
    this.body.add(bodyOf(eyeHeight_m, this.cloth));
    this.ring.add(
      new Mesh(new RingGeometry(0.955, 1, 72), this.rimPaint),
      new Mesh(new CircleGeometry(1, 72), this.discPaint),
    );
    this.showSight(null);
    this.group.add(this.body, this.sight, this.ring, this.beacon);
    this.group.visible = false;
  }

  /** Show what a lens sees; null for one that nobody has told yet. */
  showSight(lens: Lens | null): void {
    const [right, down] = lens
      ? [lens.width_px / (2 * lens.fx_px), lens.height_px / (2 * lens.fy_px)]
      : [USUAL.right, USUAL.down];
    for (const part of this.sight.children)
      if (part instanceof Mesh || part instanceof LineSegments) part.geometry.dispose();
    const { faces, edges } = pyramidOf(SIGHT_M, right, down);
    this.sight.clear();
    this.sight.add(new Mesh(faces, this.sightPaint), new LineSegments(edges, this.edgePaint));
  }

  /** Stand where the walker is, so far from the eye; null for the eye that looks out of it, which sees nothing of it. */
  show(walker: Shown, far_m: number | null): void {
    const [e, n, u] = walker.p_site_body_m;
    const [w, x, y, z] = walker.wxyz_site_body;
    this.group.visible = far_m !== null;
    this.beacon.visible = far_m !== null && far_m > BEACON_FROM_M;
    this.group.position.set(e, n, u);
    this.body.position.z = this.ring.position.z = -this.eyeHeight_m;
    this.ring.position.z += LIFT_M;
    this.body.rotation.z = -headingOfWalker(walker);
    this.sight.quaternion.set(x, y, z, w);
    // nobody shows a direction that nobody knows
    this.sight.visible = walker.told.headingKnown;
    const [east_m2 = 0, north_m2 = 0] = walker.told.variance;
    this.ring.scale.set(ringOf(east_m2), ringOf(north_m2), 1);
    this.paint(colourOfMotion(walker.told.motionModel));
  }

  dispose(): void {
    this.group.removeFromParent();
    this.group.traverse((part) => {
      if (part instanceof Mesh || part instanceof LineSegments) part.geometry.dispose();
    });
    this.beacon.material.map?.dispose();
    for (const paint of [
      this.beacon.material,
      this.cloth,
      this.rimPaint,
      this.discPaint,
      this.sightPaint,
      this.edgePaint,
    ])
      paint.dispose();
  }

  private paint(colour: Color): void {
    for (const paint of [this.rimPaint, this.discPaint, this.sightPaint, this.edgePaint]) paint.color.copy(colour);
    this.beacon.material.color.copy(colour);
  }
}

function ringOf(variance_m2: number): number {
  return Math.max(LEAST_RING_M, SURE * Math.sqrt(Math.max(0, variance_m2)));
}

/** Return a figure that stands on the ground and looks north; its feet are at zero. */
function bodyOf(eyeHeight_m: number, cloth: MeshLambertMaterial): Group {
  const profile = BODY.map(([height, radius]) => new Vector2(radius, height * eyeHeight_m));
  const draped = new LatheGeometry(profile, 28).rotateX(Math.PI / 2).scale(1, 0.72, 1);
  const head = new SphereGeometry(HEAD_M, 24, 18).scale(0.86, 1, 1.18).translate(0, 0, eyeHeight_m);
  const group = new Group();
  for (const shape of [draped, head]) group.add(new Mesh(shape, cloth));
  return group;
}

/** Return a mark over the head, as large from everywhere, that is seen through roofs: who looks from above finds the walker by it. */
function beaconOf(): Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = BEACON_PX;
  const pen = canvas.getContext("2d");
  if (pen) {
    const middle = BEACON_PX / 2;
    pen.fillStyle = "#ffffff";
    pen.strokeStyle = "#14110d";
    pen.lineWidth = 7;
    pen.lineJoin = "round";
    pen.beginPath();
    pen.arc(middle, 40, 27, 0.8 * Math.PI, 0.2 * Math.PI);
    pen.lineTo(middle, BEACON_PX - 8);
    pen.closePath();
    pen.stroke();
    pen.fill();
    pen.fillStyle = "#14110d";
    pen.beginPath();
    pen.arc(middle, 40, 10, 0, 2 * Math.PI);
    pen.fill();
  }
  const map = new CanvasTexture(canvas);
  map.colorSpace = SRGBColorSpace;
  const look = { map, sizeAttenuation: false, depthTest: false, depthWrite: false, fog: false, toneMapped: false };
  const beacon = new Sprite(new SpriteMaterial(look));
  beacon.center.set(0.5, 0);
  beacon.scale.setScalar(BEACON);
  beacon.position.z = BEACON_UP_M;
  beacon.renderOrder = 10;
  return beacon;
}

/** Return a pyramid from the eye along x, y to the left, z up. */
function pyramidOf(far_m: number, right: number, down: number): { faces: BufferGeometry; edges: BufferGeometry } {
  const [y, z] = [far_m * right, far_m * down];
  const points = [0, 0, 0, far_m, y, z, far_m, -y, z, far_m, -y, -z, far_m, y, -z];
  const places = new BufferAttribute(new Float32Array(points), 3);
  const faces = new BufferGeometry().setAttribute("position", places).setIndex([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1]);
  const edges = new BufferGeometry()
    .setAttribute("position", places.clone())
    .setIndex([0, 1, 0, 2, 0, 3, 0, 4, 1, 2, 2, 3, 3, 4, 4, 1]);
  return { faces, edges };
}
