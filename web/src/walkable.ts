/** The surface that visitors walk on today and what stands in their way, read from the site's file. three.js only to read it. */

import { Mesh, type Object3D, Vector3 as Vector } from "three";
import { Ground } from "./browse/ground";
import { Edges, type Triangle } from "./edges";
import type { Vector3 } from "./frames";
import { loader } from "./gltf";

/** Load a site's walkable surface of today and work out its edges. */
export async function loadEdges(url: string): Promise<Edges> {
  const { walkable, collision } = await load(url, "today");
  return new Edges(walkable, collision);
}

/** Load the ground of one model, to walk on. */
export async function loadGround(url: string, model: string): Promise<Ground> {
  return new Ground((await load(url, model)).walkable);
}

async function load(url: string, model: string): Promise<Record<"walkable" | "collision", Triangle[]>> {
  const { scene } = await loader.loadAsync(url);
  scene.updateMatrixWorld(true);
  const found = { walkable: [] as Triangle[], collision: [] as Triangle[] };
  scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    const role = told(object, "role");
    if (told(object, "model") !== model || (role !== "walkable" && role !== "collision")) return;
    found[role].push(...trianglesOf(object));
  });
  return found;
}

/** Return what a node, or one above it, says of itself. */
function told(object: Object3D | null, name: string): unknown {
  for (let at = object; at; at = at.parent) if (name in at.userData) return at.userData[name];
  return undefined;
}

function trianglesOf(mesh: Mesh): Triangle[] {
  const { geometry, matrixWorld } = mesh;
  const places = geometry.getAttribute("position");
  const corner = new Vector();
  const at = (index: number): Vector3 => {
    corner.fromBufferAttribute(places, geometry.index ? geometry.index.getX(index) : index).applyMatrix4(matrixWorld);
    return [corner.x, -corner.z, corner.y];
  };
  const count = geometry.index?.count ?? places.count;
  const triangles: Triangle[] = [];
  for (let i = 0; i + 2 < count; i += 3) triangles.push([at(i), at(i + 1), at(i + 2)]);
  return triangles;
}
