/** The built square: its first paint, then finer levels as they arrive, lit by the sun. three.js only. */

import {
  AmbientLight,
  Box3,
  Color,
  DirectionalLight,
  type Group as Group3D,
  HemisphereLight,
  InstancedMesh,
  Mesh,
  type Object3D,
  type Raycaster,
  Scene,
  Vector3,
} from "three";
import { MeshoptDecoder } from "three/addons/libs/meshopt_decoder.module.js";
import { type GLTF, GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { type Batches, batched } from "./batches";
import { EVIDENCE_COLOURS } from "./evidence";
import { bestOf, levelAt } from "./levels";
import { TO_SUN } from "./sky";
import { Surfaces } from "./surfaces";
import type { Thing } from "./thing";

const SHADOW_MAP_PX = 2048;
/** Half the side of the square that the sun's shadows cover, metres. */
const SHADOW_REACH_M = 130;
/** What is no monument, like the ground and what grows there, while the rest is tinted. */
const UNTOLD = new Color(0.62, 0.62, 0.6);

/** All that changes its level together: a monument, or a piece of ground. */
interface Group {
  readonly box: Box3;
  readonly levels: Map<number, Thing[]>;
  level: number | null;
  variant: string | null;
}

const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);

export class Square {
  readonly scene = new Scene();
  readonly bounds = new Box3();
  /** Called when something has come in or changed, so that it be drawn, its shadows too. */
  changed: () => void = () => undefined;
  /** Resolves when every level and the full textures are in, or have failed. */
  readonly whole: Promise<void>;
  private readonly surfaces: Surfaces;
  private readonly files: Batches[] = [];
  private readonly groups = new Map<string, Group>();
  private reach_m: readonly number[] = [];
  private eye = new Vector3();
  private evidence = false;
  private occluders: Group3D | null = null;

  /** `levels` are the model's files, the finest first; the last one is in `first`. */
  private constructor(levels: readonly string[], first: GLTF, groundShare: number) {
    this.surfaces = new Surfaces(groundShare);
    this.hideBackdrop = groundShare < 1;
    const extras = (first.asset["extras"] ?? {}) as Readonly<Record<string, unknown>>;
    if (Array.isArray(extras["level_reach_m"])) this.reach_m = extras["level_reach_m"] as number[];
    this.add(first, levels.length - 1);
    this.scene.add(...lights());
    this.update(this.eye);
    const materials = typeof extras["materials"] === "string" && levels.length > 1 ? extras["materials"] : null;
    this.whole = this.refine(levels, materials);
  }

  private readonly hideBackdrop: boolean;

  /** Load a model's coarsest level; the finer ones follow by themselves. */
  static async load(levels: readonly string[], groundShare: number): Promise<Square> {
    const first = levels.at(-1);
    if (first === undefined) throw new Error("a model without files");
    return new Square(levels, await loader.loadAsync(first), groundShare);
  }

  /** Choose every thing's level for an eye at this place, gltf axes; return whether anything has changed. */
  update(eye: Vector3): boolean {
    this.eye.copy(eye);
    let changed = false;
    for (const group of this.groups.values()) {
      const wanted = levelAt(group.box.distanceToPoint(eye), this.reach_m, group.level);
      const level = bestOf(wanted, [...group.levels.keys()]);
      if (level === group.level) continue;
      group.level = level;
      showGroup(group);
      changed = true;
    }
    return changed;
  }

  /** Tint all things by how well they are known, or no longer. */
  showEvidence(on: boolean): void {
    if (on === this.evidence) return;
    this.evidence = on;
    this.surfaces.tinted = on;
    for (const { things } of this.files) for (const thing of things) this.tint(thing);
    this.changed();
  }

  /** The reconstruction that is shown of a monument; null where there are no rivals. */
  variantOf(monument: string): string | null {
    return this.groups.get(monument)?.variant ?? null;
  }

  /** Show another reconstruction; one that the model has nothing of is an empty place. */
  showVariant(monument: string, variant: string): void {
    const group = this.groups.get(monument);
    if (!group) return;
    group.variant = variant;
    showGroup(group);
    this.changed();
  }

  /** Whether it is hidden by what stands today. */
  get hasOccluders(): boolean {
    return this.occluders?.visible ?? false;
  }

  /** Draw what stands today into the depth alone: the model is not seen behind it. */
  hideBehind(occluders: Group3D): void {
    this.occluders = occluders;
    this.scene.add(occluders);
    this.changed();
  }

  /** Return the thing that a ray meets first. */
  find(caster: Raycaster): Thing | null {
    const hit = caster.intersectObjects(this.solid, false)[0];
    if (!hit) return null;
    for (const file of this.files) {
      const thing = file.find(hit);
      if (thing) return thing;
    }
    return null;
  }

  /** Return the height of the drawn ground at a place, gltf axes; null where there is none. */
  groundAt(x: number, z: number, caster: Raycaster): number | null {
    caster.set(new Vector3(x, 500, z), new Vector3(0, -1, 0));
    const hits = caster.intersectObjects(this.solid, false);
    const ground = hits.find((hit) => this.files.some((file) => file.find(hit)?.role === "ground"));
    return ground?.point.y ?? null;
  }

  /** All that is drawn of the model. */
  private get solid(): Object3D[] {
    return this.files.flatMap(({ objects }) => objects);
  }

  dispose(): void {
    for (const object of this.scene.children) {
      if (object instanceof Mesh) object.geometry.dispose();
      if (object instanceof InstancedMesh || object instanceof DirectionalLight) object.dispose();
    }
    this.surfaces.dispose();
  }

  private async refine(levels: readonly string[], materials: string | null): Promise<void> {
    const finer = levels.map((url, level): [number, string] => [level, url]).slice(0, -1);
    try {
      if (materials !== null) {
        const [base] = levels as [string];
        await this.surfaces.refine(await loader.loadAsync(new URL(materials, new URL(base, location.href)).href));
        this.changed();
      }
      for (const [level, url] of finer.reverse()) {
        this.add(await loader.loadAsync(url), level);
        this.update(this.eye);
        this.changed();
      }
    } catch (error) {
      console.warn("the square stays coarser than it could be", error); // what is there is worth seeing
    }
  }

  private add(gltf: GLTF, level: number): void {
    const file = batched(gltf, this.surfaces);
    for (const thing of file.things) {
      if (this.hideBackdrop && thing.role === "backdrop") continue;
      this.bounds.union(thing.box);
      const group: Group = this.groups.get(thing.group) ?? {
        box: new Box3(),
        levels: new Map(),
        level: null,
        variant: null,
      };
      this.groups.set(thing.group, group);
      group.box.union(thing.box);
      group.levels.set(level, [...(group.levels.get(level) ?? []), thing]);
      group.variant ??= thing.variant;
      if (this.evidence) this.tint(thing);
    }
    this.files.push(file);
    this.scene.add(...file.objects);
  }

  private tint(thing: Thing): void {
    const colour =
      thing.evidence === null || thing.monument === null ? UNTOLD : new Color(EVIDENCE_COLOURS[thing.evidence]);
    thing.tint(this.evidence ? colour : null);
  }
}

function showGroup({ levels, level, variant }: Group): void {
  for (const [of, things] of levels)
    for (const thing of things) thing.show(of === level && (thing.variant === null || thing.variant === variant));
}

function lights(): Object3D[] {
  const sun = new DirectionalLight(0xfff1dc, 2.6);
  sun.position
    .copy(TO_SUN)
    .multiplyScalar(200)
    .add(new Vector3(-25, 0, 10));
  sun.target.position.set(-25, 0, 10);
  sun.target.updateMatrixWorld();
  sun.castShadow = true;
  sun.shadow.mapSize.set(SHADOW_MAP_PX, SHADOW_MAP_PX);
  sun.shadow.bias = -0.0006;
  sun.shadow.normalBias = 0.08;
  const { camera } = sun.shadow;
  [camera.left, camera.right, camera.bottom, camera.top] = [-1, 1, -1, 1].map((side) => side * SHADOW_REACH_M) as [
    number,
    number,
    number,
    number,
  ];
  [camera.near, camera.far] = [20, 420];
  return [sun, new HemisphereLight(0xcfe3ff, 0xb59a78, 1.15), new AmbientLight(0xffffff, 0.12)];
}
