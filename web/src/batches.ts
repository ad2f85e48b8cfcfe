/** A level of a model as few draw calls: all that is of one material in one batch, every thing of it shown or hidden alone. */

import {
  BatchedMesh,
  Box3,
  type BufferGeometry,
  type Color,
  InstancedMesh,
  type Intersection,
  type Material,
  Matrix4,
  Mesh,
  type Object3D,
} from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type Post, postIn } from "./browse/post";
import { type Cells, cellOf, parseCells } from "./cells";
import { isMergeable, type Laid, merged } from "./merge";
import type { Surfaces } from "./surfaces";
import { type Extras, Thing } from "./thing";

/** So long the page's thread sorts without a pause. */
const SLICE_MS = 20;

/** Everything of one file. */
export interface Batches {
  readonly objects: readonly Object3D[];
  readonly things: readonly Thing[];
  /** What of the buildings stands upright and slender, like columns: nobody walks through it. */
  readonly posts: readonly Post[];
  /** Return what a ray has hit, if it is of this file. */
  find(hit: Intersection): Thing | null;
}

/** Sort the meshes of a file into batches, everything hidden, piece by piece: `made` is told of what each has brought, and waited for. */
export async function batched(
  gltf: GLTF,
  surfaces: Surfaces,
  made: (objects: readonly Object3D[]) => Promise<void>,
): Promise<Batches> {
  const sorting = new Sorting(gltf, surfaces);
  let told = 0;
  let began_ms = performance.now();
  for (const count of sorting.steps()) {
    if (count > told) await made(sorting.sorted.objects.slice(told, count));
    told = count;
    if (performance.now() - began_ms < SLICE_MS) continue;
    await new Promise((resolve) => setTimeout(resolve));
    began_ms = performance.now();
  }
  return sorting.sorted;
}

class Sorting {
  private readonly objects: Object3D[] = [];
  private readonly posts: Post[] = [];
  private readonly things = new Map<string, Thing>();
  private readonly owners = new Map<Object3D, Thing | Thing[]>();
  /** By material and whether it is ground, by thing: what becomes one geometry. */
  private readonly plain = new Map<Material, Map<Thing, Laid[]>>();
  private readonly cells: Cells | null;
  private readonly many: number;

  constructor(
    private readonly gltf: GLTF,
    private readonly surfaces: Surfaces,
  ) {
    const extras = (gltf.asset["extras"] ?? {}) as Extras;
    this.cells = parseCells(extras["cells"]);
    this.many = typeof extras["many_triangles"] === "number" ? extras["many_triangles"] : 0;
    gltf.scene.updateMatrixWorld(true);
  }

  /** Sort all of it, step by step; each tells how many objects there are now. */
  *steps(): Iterable<number> {
    for (const child of this.gltf.scene.children) {
      const [name, extras] = this.nameOf(child);
      child.traverse((mesh) => {
        if (mesh instanceof InstancedMesh) this.sortCopies(mesh, name, extras);
        else if (mesh instanceof Mesh) this.sort(mesh, mesh.matrixWorld, this.thing(name, extras));
      });
      yield this.objects.length;
    }
    for (const [material, members] of this.plain) {
      yield* this.batch(material, members);
      yield this.objects.length;
    }
  }

  /** What is sorted so far. */
  get sorted(): Batches {
    const { owners } = this;
    const find = ({ object, batchId }: Intersection): Thing | null => {
      const owner = owners.get(object);
      return Array.isArray(owner) ? (owner[batchId ?? 0] ?? null) : (owner ?? null);
    };
    return { objects: this.objects, things: [...this.things.values()], posts: this.posts, find };
  }

  private thing(name: string, extras: Extras): Thing {
    const thing = this.things.get(name) ?? new Thing(name, extras);
    this.things.set(name, thing);
    return thing;
  }

  private sort(mesh: Mesh, T_world_geometry: Matrix4, thing: Thing): void {
    const material = this.surfaces.of(materialOf(mesh), thing.isGround);
    if (!isMergeable(mesh.geometry)) {
      this.keep(mesh, thing);
      return;
    }
    const members = this.plain.get(material) ?? new Map<Thing, Laid[]>();
    this.plain.set(material, members);
    members.set(thing, [...(members.get(thing) ?? []), { geometry: mesh.geometry, T_world_geometry }]);
  }

  /** Copies of a wide thing go into their cells; where there are few triangles in all, the copies become one geometry. */
  private sortCopies(mesh: InstancedMesh, name: string, extras: Extras): void {
    const rows = Array.from({ length: mesh.count }, (_, i) => {
      const T = new Matrix4();
      mesh.getMatrixAt(i, T);
      return T.premultiply(mesh.matrixWorld);
    });
    if (extras["monument"] && !extras["variant"]) this.posts.push(...postsOf(mesh.geometry, rows));
    for (const [place, own] of this.byCell(rows, name, extras)) {
      const thing = this.thing(place, extras);
      const triangles = (own.length * (mesh.geometry.index?.count ?? 0)) / 3;
      if (triangles < this.many) for (const T of own) this.sort(mesh, T, thing);
      else this.keepCopies(mesh, own, thing);
    }
  }

  private byCell(rows: readonly Matrix4[], name: string, extras: Extras): ReadonlyMap<string, Matrix4[]> {
    const { cells } = this;
    const found = new Map<string, Matrix4[]>();
    const isWide = cells && !extras["monument"] && extras["role"] !== "backdrop" && !name.includes("@");
    for (const T of rows) {
      const place = isWide ? `${name}@${cellOf(cells, T.elements[12], -T.elements[14])}` : name;
      found.set(place, [...(found.get(place) ?? []), T]);
    }
    return found;
  }

  private keepCopies(mesh: InstancedMesh, rows: readonly Matrix4[], thing: Thing): void {
    const material = this.surfaces.of(materialOf(mesh), thing.isGround);
    const copies = new InstancedMesh(mesh.geometry, material, rows.length);
    rows.forEach((T, i) => {
      copies.setMatrixAt(i, T);
    });
    copies.computeBoundingBox();
    if (copies.boundingBox) thing.box.union(copies.boundingBox);
    this.lay(copies, thing);
    thing.parts.push({
      show: (visible) => {
        copies.visible = visible;
      },
      tint: (colour) => {
        for (let i = 0; i < copies.count; i++) copies.setColorAt(i, colour);
        if (copies.instanceColor) copies.instanceColor.needsUpdate = true;
      },
    });
  }

  /** A mesh of other attributes than ours is drawn by itself. */
  private keep(loaded: Mesh, thing: Thing): void {
    const mesh = new Mesh(loaded.geometry, materialOf(loaded).clone());
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(loaded.matrixWorld);
    thing.box.expandByObject(loaded);
    this.lay(mesh, thing);
    const { color } = mesh.material as Material & { readonly color?: Color };
    const own = color?.clone();
    thing.parts.push({
      show: (visible) => {
        mesh.visible = visible;
      },
      tint: (colour) => {
        if (own) color?.copy(own).multiply(colour);
      },
    });
  }

  private *batch(material: Material, members: ReadonlyMap<Thing, Laid[]>): Iterable<number> {
    const geometries: [Thing, BufferGeometry][] = [];
    for (const [thing, laid] of members) {
      geometries.push([thing, merged(laid)]);
      yield this.objects.length;
    }
    const total = (count: (geometry: BufferGeometry) => number): number =>
      geometries.reduce((sum, [, geometry]) => sum + count(geometry), 0);
    const vertices = total((geometry) => geometry.getAttribute("position").count);
    const batch = new BatchedMesh(
      geometries.length,
      vertices,
      total((geometry) => geometry.index?.count ?? 0),
      material,
    );
    for (const [thing, geometry] of geometries) {
      const id = batch.addInstance(batch.addGeometry(geometry));
      batch.setVisibleAt(id, false);
      thing.box.union(batch.getBoundingBoxAt(batch.getGeometryIdAt(id), new Box3()) ?? new Box3());
      thing.parts.push({
        show: (visible) => {
          batch.setVisibleAt(id, visible);
        },
        tint: (colour) => {
          batch.setColorAt(id, colour);
        },
      });
      yield this.objects.length;
    }
    const [first] = geometries;
    if (first) this.lay(batch, first[0]);
    this.owners.set(
      batch,
      geometries.map(([thing]) => thing),
    );
    batch.visible = true;
  }

  private lay(mesh: Mesh, thing: Thing): void {
    mesh.castShadow = !thing.isGround;
    mesh.receiveShadow = true;
    mesh.visible = false;
    this.objects.push(mesh);
    this.owners.set(mesh, thing);
  }

  /** three.js rewrites names and mixes extras into them: what the file says stands in its JSON. */
  private nameOf(object: Object3D): [string, Extras] {
    const { parser } = this.gltf;
    const index = parser.associations.get(object)?.nodes;
    const node = index === undefined ? undefined : parser.json["nodes"]?.[index];
    return [typeof node?.name === "string" ? node.name : object.name, (node?.extras ?? {}) as Extras];
  }
}

/** Return the copies that stand upright and slender, site frame. */
function postsOf(geometry: BufferGeometry, rows: readonly Matrix4[]): Post[] {
  geometry.computeBoundingBox();
  const own = geometry.boundingBox;
  if (!own) return [];
  return rows.flatMap((T) => {
    const box = own.clone().applyMatrix4(T);
    return postIn([box.min.x, -box.max.z, box.min.y], [box.max.x, -box.min.z, box.max.y]) ?? [];
  });
}

function materialOf(mesh: Mesh): Material {
  const { material } = mesh;
  const first = Array.isArray(material) ? material[0] : material;
  if (!first) throw new Error(`${mesh.name} is of no material`);
  return first;
}
