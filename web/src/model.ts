/** The built square: loaded, lit by the sun, with a ground that lets the real one through. three.js only. */

import {
  AmbientLight,
  Box3,
  DirectionalLight,
  type Group,
  HemisphereLight,
  Mesh,
  MeshStandardMaterial,
  NoBlending,
  type Object3D,
  Scene,
  Vector3,
} from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const SHADOW_MAP_PX = 2048;
/** Half the side of the square that the sun's shadows cover, metres. */
const SHADOW_REACH_M = 130;

export interface Square {
  readonly scene: Scene;
  readonly model: Group;
  readonly bounds: Box3;
}

/** Load a model and light it. `groundShare` is how much of the ground is drawn: 1 hides the real one. */
export async function loadSquare(url: string, groundShare: number): Promise<Square> {
  const { scene: model } = await new GLTFLoader().loadAsync(url);
  const thinned = new Map<MeshStandardMaterial, MeshStandardMaterial>();
  model.traverse((node) => {
    if (!(node instanceof Mesh)) return;
    const ground = isGround(node);
    node.castShadow = !ground;
    node.receiveShadow = true;
    const { material } = node;
    if (!ground || groundShare >= 1 || !(material instanceof MeshStandardMaterial)) return;
    // buildings may be of the same material, and stay whole
    const thin = thinned.get(material) ?? thinnedCopy(material, groundShare);
    thinned.set(material, thin);
    node.material = thin;
  });
  const scene = new Scene();
  scene.add(model, ...lights());
  return { scene, model, bounds: new Box3().setFromObject(model) };
}

/** Whether the node, or one that it is part of, is ground rather than building: the model says so itself. */
export function isGround(node: Object3D): boolean {
  for (let part: Object3D | null = node; part !== null; part = part.parent)
    if (part.userData["role"] === "ground") return true;
  return false;
}

/** Write a share of the colour, and that share as coverage: what lies in front of the ground is not seen through. */
function thinnedCopy(material: MeshStandardMaterial, share: number): MeshStandardMaterial {
  const thin = material.clone();
  thin.blending = NoBlending;
  thin.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <dithering_fragment>",
      `#include <dithering_fragment>\n gl_FragColor *= ${share.toFixed(3)};`,
    );
  };
  return thin;
}

/** Late morning in June: the sun stands high in the south-east. */
function lights(): (AmbientLight | HemisphereLight | DirectionalLight)[] {
  const sun = new DirectionalLight(0xfff1dc, 2.6);
  const toSun = new Vector3(0.55, 0.75, 0.5).normalize();
  sun.position.copy(toSun.multiplyScalar(200)).add(new Vector3(-25, 0, 10));
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
