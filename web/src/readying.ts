/**
 * Handing work to the graphics card so that the page's own thread never waits for it. three.js only.
 *
 * What asks the card for something waits until all that it was given before is done. So programs are compiled before they are
 * used, and whatever asks does so when the card has nothing else to do.
 */

import {
  type Camera,
  Group,
  type Material,
  Mesh,
  MeshDepthMaterial,
  type Scene,
  Texture,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";

/** So long after the last look comes the next one: timers are not faster, and what takes long is looked for less often. */
const FIRST_LOOK_MS = 4;
const LAST_LOOK_MS = 24;
const LONGEST_MS = 2000;
/** So long the page's thread asks without a pause. */
const SLICE_MS = 30;
/** So many pictures are waited for. */
const PATIENCE = 5;
/** three.js throws shadows by the far side of what is seen from one side only: `WebGLShadowMap`. */
const SHADOW_SIDE = [1, 0, 2] as const;

/** What three.js's programs can tell, which its types do not. */
interface Program {
  isReady(): boolean;
  getUniforms(): unknown;
}

export class Readying {
  /** What shadows are drawn with is chosen by three.js: programs as it will ask for are held by materials like its own. */
  private readonly depths = new Map<string, MeshDepthMaterial>();
  private readonly map = new Texture();
  private readonly target = new WebGLRenderTarget(1, 1);
  private readonly known = new WeakSet<object>();

  constructor(private readonly renderer: WebGLRenderer) {}

  /** Compile what a scene is drawn with as it is dressed now, what is hidden too; resolves when it can be drawn at once. */
  async compile(scene: Scene, camera: Camera): Promise<void> {
    this.renderer.compile(scene, camera);
    this.compileShadows(scene, camera);
    const programs = ((this.renderer.info.programs ?? []) as unknown as Program[]).filter(
      (program) => !this.known.has(program),
    );
    await this.until(() => programs.every((program) => program.isReady()));
    await this.idle();
    let began_ms = performance.now();
    for (const program of programs) {
      this.known.add(program);
      program.getUniforms();
      if (performance.now() - began_ms < SLICE_MS) continue;
      await pause(FIRST_LOOK_MS);
      began_ms = performance.now();
    }
  }

  /** Resolves when the card has nothing to do, or hardly anything where it draws all the time. */
  async idle(): Promise<void> {
    const { render } = this.renderer.info;
    for (let i = 0; i < PATIENCE; i++) {
      const { frame } = render;
      await this.drained();
      if (frame === render.frame) return;
    }
  }

  /** Resolves when the card has done all that it was given so far. */
  async drained(): Promise<void> {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence) return;
    await this.until(() => gl.clientWaitSync(fence, gl.SYNC_FLUSH_COMMANDS_BIT, 0) !== gl.TIMEOUT_EXPIRED);
    gl.deleteSync(fence);
  }

  /** Resolves when something holds; a card that never says so is not waited for. */
  private async until(holds: () => boolean): Promise<void> {
    const gl = this.renderer.getContext();
    const began_ms = performance.now();
    let next_ms = FIRST_LOOK_MS;
    do {
      gl.flush(); // Chromium looks what is done only when it is given something, if another page draws meanwhile
      await pause(next_ms);
      next_ms = Math.min(LAST_LOOK_MS, 1.5 * next_ms);
    } while (!holds() && performance.now() - began_ms < LONGEST_MS);
  }

  private compileShadows(scene: Scene, camera: Camera): void {
    const casters = new Map<Mesh, Material | Material[]>();
    scene.traverse((object) => {
      if (object instanceof Mesh && object.castShadow) casters.set(object, object.material);
    });
    const { renderer } = this;
    const { fog } = scene;
    const target = renderer.getRenderTarget();
    const group = new Group();
    group.children.push(...casters.keys()); // they stay the scene's own
    for (const [mesh, material] of casters) mesh.material = this.depthOf(material);
    scene.fog = null;
    renderer.setRenderTarget(this.target);
    renderer.compile(group, camera, scene);
    renderer.setRenderTarget(target);
    scene.fog = fog;
    for (const [mesh, material] of casters) mesh.material = material;
  }

  private depthOf(material: Material | Material[]): Material | Material[] {
    if (Array.isArray(material)) return material;
    const hasMap = "map" in material && material.map !== null;
    const side = material.shadowSide ?? SHADOW_SIDE[material.side];
    const key = `${side} ${hasMap}`;
    const depth = this.depths.get(key) ?? new MeshDepthMaterial({ side, map: hasMap ? this.map : null });
    this.depths.set(key, depth);
    return depth;
  }
}

function pause(wait_ms: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, wait_ms));
}
