/** The built square: its first paint, then finer levels as they arrive, lit by the sun. three.js only. */

import {
  Box3,
  Color,
  type Group as Group3D,
  InstancedMesh,
  Mesh,
  type Object3D,
  type Raycaster,
  Scene,
  type Texture,
  Vector3,
} from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type Batches, batched } from "./batches";
import type { Post } from "./browse/post";
import { EVIDENCE_COLOURS } from "./evidence";
import { loader } from "./gltf";
import { bestOf, levelAt } from "./levels";
import type { Effort } from "./quality";
import type { Sun } from "./sun";
import { Sunlight } from "./sunlight";
import { Surfaces } from "./surfaces";
import type { Thing } from "./thing";

/** What is no monument, like the ground and what grows there, while the rest is tinted. */
const UNTOLD = new Color(0.62, 0.62, 0.6);

/** How it is drawn. */
type Drawn = Pick<Effort, "plain" | "shadows" | "occluders" | "landscape" | "finest">;
/** Where nobody chooses. */
const ALL: Drawn = { plain: false, shadows: true, occluders: true, landscape: true, finest: 0 };

/** All that changes its level together: a monument, or a piece of ground. */
interface Group {
  readonly box: Box3;
  /** Whether it is no monument, nor part of one. */
  readonly isLandscape: boolean;
  readonly levels: Map<number, Thing[]>;
  level: number | null;
  variant: string | null;
}

export class Square {
  readonly scene = new Scene();
  readonly bounds = new Box3();
  /** What stands upright and slender in it. */
  readonly posts: readonly Post[];
  /** Called when something has come in or changed, so that it be drawn, its shadows too. */
  changed: () => void = () => undefined;
  /** Called when something has come in that should go to the graphics card before the next does. */
  pause: (pictures: readonly Texture[]) => Promise<void> = () => new Promise((resolve) => setTimeout(resolve));
  private readonly light = new Sunlight();
  private readonly files: Batches[] = [];
  private readonly groups = new Map<string, Group>();
  private reach_m: readonly number[] = [];
  private eye = new Vector3();
  private evidence = false;
  private occluders: Group3D | null = null;
  private readonly hideBackdrop: boolean;
  private readonly materials: string | null;
  private refining: Promise<void> = Promise.resolve();
  /** The finest level that was asked for. */
  private asked: number;
  private loading = 0;
  private whole: boolean;
  private effort: Drawn = ALL;

  /** `levels` are the model's files, the finest first; the last one is in `first`. */
  private constructor(
    private readonly levels: readonly string[],
    first: GLTF,
    file: Batches,
    private readonly surfaces: Surfaces,
    groundShare: number,
  ) {
    this.hideBackdrop = groundShare < 1;
    this.asked = levels.length - 1;
    this.whole = this.asked === 0;
    const extras = (first.asset["extras"] ?? {}) as Readonly<Record<string, unknown>>;
    if (Array.isArray(extras["level_reach_m"])) this.reach_m = extras["level_reach_m"] as number[];
    this.posts = file.posts;
    void this.lay(file.objects);
    this.take(file, levels.length - 1);
    this.scene.add(...this.light.objects);
    this.update(this.eye);
    this.materials = typeof extras["materials"] === "string" && levels.length > 1 ? extras["materials"] : null;
  }

  /** Load a model's coarsest level; `come` is told how much of it has come, 0 to 1. */
  static async load(
    levels: readonly string[],
    groundShare: number,
    come: (share: number) => void = () => undefined,
  ): Promise<Square> {
    const first = levels.at(-1);
    if (first === undefined) throw new Error("a model without files");
    const onProgress = ({ loaded, total }: ProgressEvent): void => {
      if (total > 0) come(loaded / total); // a server that packs it does not tell how much there is
    };
    const [loaded, surfaces] = [await loader.loadAsync(first, onProgress), new Surfaces(groundShare)];
    return new Square(levels, loaded, await batched(loaded, surfaces, async () => undefined), surfaces, groundShare);
  }

  /** Load the levels down to this one, for all of them the full textures, too; resolves when they are in, or have failed. */
  refine(finest = 0): Promise<void> {
    if (this.asked <= finest) return this.refining;
    const levels: number[] = [];
    while (this.asked > finest) levels.push(--this.asked);
    this.loading += 1;
    this.refining = this.refining
      .then(() => this.load(levels))
      .then(() => {
        this.loading -= 1;
      });
    return this.refining;
  }

  /** Whether all that is finer is in, or has failed. */
  get isWhole(): boolean {
    return this.whole;
  }

  /** Whether something finer is coming in just now: that slows the pictures down. */
  get isLoading(): boolean {
    return this.loading > 0;
  }

  /** Choose every thing's level for an eye at this place, gltf axes; return whether anything has changed. */
  update(eye: Vector3): boolean {
    this.eye.copy(eye);
    let changed = false;
    for (const group of this.groups.values()) {
      const wanted = levelAt(group.box.distanceToPoint(eye), this.reach_m, group.level);
      const isShown = this.effort.landscape || !group.isLandscape;
      const level = isShown ? bestOf(Math.max(this.effort.finest, wanted), [...group.levels.keys()]) : null;
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

  /** How many looks at a texture its drawing has time for. */
  set anisotropy(most: number) {
    this.surfaces.anisotropy = most;
  }

  /** Light it by a sun at this place of the sky. */
  shine(sun: Sun): void {
    this.light.shine(sun);
    this.surfaces.shade = this.light.shade;
    this.changed();
  }

  /** Choose what of it is drawn, and how. */
  work(effort: Drawn): void {
    this.effort = effort;
    this.light.shadows = effort.shadows;
    if (this.occluders) this.occluders.visible = effort.occluders;
    for (const { objects } of this.files) this.clothe(objects);
    this.update(this.eye);
    this.changed();
    void this.refine(effort.finest);
  }

  /** Draw what stands today into the depth alone: the model is not seen behind it. */
  hideBehind(occluders: Group3D): void {
    this.occluders = occluders;
    occluders.visible = this.effort.occluders;
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

  /** Return where a ray first meets what is drawn, gltf axes; null where it does not. */
  hit(caster: Raycaster): Vector3 | null {
    return caster.intersectObjects(this.solid, false)[0]?.point ?? null;
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
      if (object instanceof InstancedMesh) object.dispose();
    }
    this.light.dispose();
    this.surfaces.dispose();
  }

  private async load(levels: readonly number[]): Promise<void> {
    try {
      if (levels.includes(0)) await this.loadSurfaces();
      for (const level of levels) {
        const gltf = await loader.loadAsync(this.levels[level] ?? "");
        this.take(await batched(gltf, this.surfaces, (objects) => this.lay(objects)), level);
        this.update(this.eye);
        this.changed();
      }
    } catch (error) {
      console.warn("the square stays coarser than it could be", error); // what is there is worth seeing
    }
    if (!levels.includes(0)) return;
    this.whole = true;
    this.changed();
  }

  private async loadSurfaces(): Promise<void> {
    if (this.materials === null) return;
    const [base] = this.levels as [string];
    const full = await loader.loadAsync(new URL(this.materials, new URL(base, location.href)).href);
    await this.surfaces.refine(full, (pictures) => this.pause(pictures));
    this.changed();
  }

  /** Put what is not shown yet into the scene. */
  private lay(objects: readonly Object3D[]): Promise<void> {
    this.clothe(objects);
    this.scene.add(...objects);
    return this.pause([]);
  }

  private take(file: Batches, level: number): void {
    for (const thing of file.things) {
      if (this.hideBackdrop && thing.role === "backdrop") continue;
      this.bounds.union(thing.box);
      const group: Group = this.groups.get(thing.group) ?? {
        box: new Box3(),
        isLandscape: thing.monument === null,
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
  }

  private clothe(objects: readonly Object3D[]): void {
    for (const object of objects)
      if (object instanceof Mesh) object.material = this.surfaces.worn(object.material, this.effort.plain);
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
