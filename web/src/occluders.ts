/** What stands today and hides the model: drawn into its depth alone, never into its colours. three.js only. */

import { type Group, Mesh, MeshBasicMaterial } from "three";
import { loader } from "./gltf";

/** Before everything else of the scene, whatever stands where. */
const FIRST = -100;
/** The ground's stand-in lies this much lower, so that what is built on the ground keeps its foot. */
const GROUND_LOWERED_M = 0.3;
const GROUND = "ground";

/** Load a site's stand-ins for what is there today. */
export async function loadOccluders(url: string): Promise<Group> {
  const gltf = await loader.loadAsync(url);
  const unseen = new MeshBasicMaterial({ colorWrite: false });
  gltf.scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.material = unseen;
    object.renderOrder = FIRST;
  });
  for (const child of gltf.scene.children) if (child.name === GROUND) child.position.y -= GROUND_LOWERED_M;
  gltf.scene.updateMatrixWorld(true);
  gltf.scene.matrixWorldAutoUpdate = false;
  return gltf.scene;
}
