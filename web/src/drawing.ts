/** The model drawn from where a picture was taken: an exact pinhole into a target that covers all that the lens sees. */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DepthTexture,
  HalfFloatType,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { type Matrix4, viewFromCam } from "./frames";
import type { Lens } from "./lens";
import { drawingSize, type Window } from "./lookup";
import type { Square } from "./model";
import { type Doubted, SoftEdges } from "./soften";

const NEAR_M = 0.1;
const FAR_M = 900;
const LARGEST_PX = 3072;
const TARGET_PX = 7;
const BACKGROUND = new Color(0x0b0a08);

export interface Sight {
  readonly lens: Lens;
  /** What of the ideal plane is drawn. */
  readonly window: Window;
  readonly T_site_cam: Matrix4;
  /** Null: every edge is sharp. */
  readonly doubt: Doubted | null;
  /** How far the eye is to the right of the camera, metres. */
  readonly aside_m: number;
  /** Between how many the canvas is divided. */
  readonly eyes: number;
}

export class Drawing {
  readonly target = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples: 4 });
  readonly soft = new SoftEdges();
  /** Whether `soft` is of this drawing. */
  isSoft = false;
  /** Pixels of the drawing for one of the screen, along each side. */
  fineness = 1;
  /** What the last one cost, shadows left out. */
  cost = { calls: 0, triangles: 0 };
  private readonly depth = new DepthTexture(1, 1);
  private readonly camera = new PerspectiveCamera();
  private readonly eye = new Vector3();
  private points: Points<BufferGeometry, PointsMaterial> | null = null;

  constructor(private readonly renderer: WebGLRenderer) {
    this.target.depthTexture = this.depth;
    this.camera.matrixAutoUpdate = false;
  }

  /** How many samples a pixel has: 0 is without smooth edges. */
  set samples(count: number) {
    if (this.target.samples === count) return;
    this.target.samples = count;
    this.target.dispose();
  }

  /** Draw a square as it is seen. */
  render(square: Square, sight: Sight): void {
    const { renderer, camera, target } = this;
    const { lens, window } = sight;
    this.fit(sight);
    this.aim(sight);
    if (square.update(this.eye.setFromMatrixPosition(camera.matrixWorld))) renderer.shadowMap.needsUpdate = true;
    if (this.points)
      this.points.material.size = TARGET_PX * (target.width / ((window.right - window.left) * lens.fx_px));
    const shadowsToo = renderer.shadowMap.needsUpdate;
    renderer.info.reset();
    renderer.setRenderTarget(target);
    renderer.setClearColor(0x000000, 0);
    renderer.render(square.scene, camera);
    renderer.shadowMap.needsUpdate = false; // three leaves it where no light throws shadows
    renderer.setClearColor(BACKGROUND, 1);
    const { calls, triangles } = renderer.info.render;
    if (!shadowsToo || this.cost.calls === 0) this.cost = { calls, triangles };
    const focal_px = target.width / (window.right - window.left);
    this.isSoft =
      sight.doubt !== null && this.soft.take(renderer, target, this.depth, focal_px, sight.doubt, [NEAR_M, FAR_M]);
  }

  /** Draw small squares of colour at points of the gltf world, over everything or where they are not hidden: for tests. */
  mark(
    square: Square,
    points_gltf: readonly (readonly [number, number, number])[],
    colours: readonly string[],
    hideable: boolean,
  ): void {
    if (this.points) square.scene.remove(this.points);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points_gltf.flat()), 3));
    const rgb = colours.flatMap((colour) => new Color(colour).toArray());
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(rgb), 3));
    const looks = { vertexColors: true, sizeAttenuation: false, depthTest: hideable, toneMapped: false };
    this.points = new Points(geometry, new PointsMaterial(looks));
    this.points.renderOrder = 1000;
    this.points.frustumCulled = false;
    square.scene.add(this.points);
  }

  private fit({ lens, window, eyes }: Sight): void {
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    const shown = Math.max(0.5, Math.min(size.x / eyes / lens.width_px, size.y / lens.height_px));
    const [width, height] = drawingSize(lens, window, shown * this.fineness, LARGEST_PX);
    if (this.target.width !== width || this.target.height !== height) this.target.setSize(width, height);
  }

  private aim({ window, T_site_cam, aside_m }: Sight): void {
    const { camera } = this;
    const [left, right, top, bottom] = [window.left, window.right, -window.top, -window.bottom].map(
      (x) => x * NEAR_M,
    ) as [number, number, number, number];
    camera.projectionMatrix.makePerspective(left, right, top, bottom, NEAR_M, FAR_M, camera.coordinateSystem);
    camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
    camera.matrix.fromArray(viewFromCam(T_site_cam) as number[]).transpose();
    if (aside_m !== 0) camera.matrix.setPosition(new Vector3(aside_m, 0, 0).applyMatrix4(camera.matrix));
    camera.updateMatrixWorld(true);
  }
}
