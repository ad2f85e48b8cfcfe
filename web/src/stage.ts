/** The square on the start page: turned about from above, or looked at from a place in it. Draws only when something changes. */

import { ACESFilmicToneMapping, Fog, PerspectiveCamera, Raycaster, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Square } from "./model";
import type { View } from "./site";
import { HORIZON, makeSky } from "./sky";
import type { Thing } from "./thing";

/** From over the south-east corner, along the square; gltf axes, metres. */
const VIEW_FROM = [78, 66, 112] as const;
const VIEW_OF = [-25, 2, 0] as const;
const FLYING = { field_deg: 45, nearest_m: 8, lowest_rad: 1.5 } as const;
/** A standing visitor turns about a point just ahead; `assets/levels.py` tells costs for this field of view. */
const STANDING = { field_deg: 46.7, ahead_m: 1, lowest_rad: 2.4 } as const;
/** On a screen held upright the field of view grows upwards, so that at least this much is seen across. */
const LEAST_WIDTH_DEG = 38;

export class Stage {
  readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(FLYING.field_deg, 1, 0.2, 1500);
  private readonly controls: OrbitControls;
  private readonly caster = new Raycaster();
  private square: Square | null = null;
  private standing: View | null = null;
  private asked = false;
  private cost = { calls: 0, triangles: 0 };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly eyeHeight_m: number,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxDistance = 320;
    this.controls.enableDamping = false;
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.ask());
    new ResizeObserver(() => this.fill()).observe(canvas);
    this.fly();
  }

  /** What the last drawing cost, shadows left out. */
  get stats(): { readonly drawCalls: number; readonly triangles: number } {
    return { drawCalls: this.cost.calls, triangles: this.cost.triangles };
  }

  /** Whether all that was asked for is drawn. */
  get isSettled(): boolean {
    return !this.asked;
  }

  /** Draw this square from now on. */
  show(square: Square): void {
    this.square?.dispose();
    this.square = square;
    square.scene.add(makeSky());
    square.scene.fog = new Fog(HORIZON, 220, 900);
    square.changed = () => {
      if (this.standing) this.place(this.standing); // a finer ground may be a little higher
      this.renderer.shadowMap.needsUpdate = true;
      this.ask();
    };
    square.changed();
  }

  /** Look from above again. */
  fly(): void {
    this.standing = null;
    this.camera.position.set(...VIEW_FROM);
    this.controls.target.set(...VIEW_OF);
    this.controls.minDistance = FLYING.nearest_m;
    this.controls.maxPolarAngle = FLYING.lowest_rad;
    this.controls.rotateSpeed = 1;
    this.fill();
  }

  /** Stand in the square. */
  stand(view: View): void {
    this.standing = view;
    this.controls.minDistance = STANDING.ahead_m;
    this.controls.maxPolarAngle = STANDING.lowest_rad;
    this.controls.rotateSpeed = -0.4; // the picture follows the finger
    this.place(view);
    this.fill();
  }

  /** Return what is drawn at a point of the window. */
  at({ clientX, clientY }: MouseEvent): Thing | null {
    this.caster.setFromCamera(
      new Vector2((2 * clientX) / innerWidth - 1, 1 - (2 * clientY) / innerHeight),
      this.camera,
    );
    return this.square?.find(this.caster) ?? null;
  }

  private place({ e_m, n_m, heading_rad, pitch_rad }: View): void {
    const ground_m = this.square?.groundAt(e_m, -n_m, this.caster) ?? 0;
    this.camera.position.set(e_m, ground_m + this.eyeHeight_m, -n_m);
    const flat = Math.cos(pitch_rad);
    const ahead = new Vector3(flat * Math.sin(heading_rad), Math.sin(pitch_rad), -flat * Math.cos(heading_rad));
    this.controls.target.copy(this.camera.position).addScaledVector(ahead, STANDING.ahead_m);
    this.controls.update();
  }

  private fill(): void {
    const { canvas, camera } = this;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    camera.aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight);
    camera.fov = fieldOf(camera.aspect, this.standing ? STANDING.field_deg : FLYING.field_deg);
    camera.updateProjectionMatrix();
    this.controls.update();
    this.ask();
  }

  private ask(): void {
    if (!this.asked) requestAnimationFrame(() => this.draw());
    this.asked = true;
  }

  private draw(): void {
    this.asked = false;
    if (!this.square) return;
    if (this.square.update(this.camera.position)) this.renderer.shadowMap.needsUpdate = true;
    if (this.renderer.shadowMap.needsUpdate) this.ask(); // the next drawing is counted without the shadows'
    this.renderer.render(this.square.scene, this.camera);
    const { calls, triangles } = this.renderer.info.render;
    this.cost = { calls, triangles };
  }
}

/** Return the vertical field of view, degrees, that shows the width of the square on a screen of this shape. */
function fieldOf(aspect: number, least_deg: number): number {
  const halfWidth = Math.tan((LEAST_WIDTH_DEG * Math.PI) / 360);
  return Math.max(least_deg, (Math.atan(halfWidth / aspect) * 360) / Math.PI);
}
