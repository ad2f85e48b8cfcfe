/** The materials of a square, one for each name however many files it comes in; small textures at first, full ones later. */

import { type Material, MeshStandardMaterial, NoBlending } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";

const ANISOTROPY = 4;
const PICTURES = ["map", "normalMap", "roughnessMap", "metalnessMap"] as const;

export class Surfaces {
  private readonly made = new Map<string, MeshStandardMaterial>();
  /** 1: colours give way to greys, which take the tint of their evidence. */
  private readonly grey = { value: 0 };
  private full = new Map<string, MeshStandardMaterial>();

  /** `groundShare` is how much of the ground is drawn: 1 hides the real one. */
  constructor(private readonly groundShare: number) {}

  set tinted(on: boolean) {
    this.grey.value = on ? 1 : 0;
  }

  /** Return the shared material of that name; `loaded` as it came is the first of its kind. */
  of(loaded: Material, ground: boolean): Material {
    if (!(loaded instanceof MeshStandardMaterial)) return loaded;
    const key = `${loaded.name}${ground ? " (ground)" : ""}`;
    let material = this.made.get(key);
    if (!material) {
      material = loaded.clone();
      this.patch(material, ground && this.groundShare < 1 ? this.groundShare : null);
      this.made.set(key, material);
      const full = this.full.get(loaded.name);
      if (full) refine(material, full);
    }
    return material;
  }

  /** Take the full textures from a file of materials. */
  async refine(gltf: GLTF): Promise<void> {
    const materials = (await gltf.parser.getDependencies("material")) as Material[];
    for (const full of materials) if (full instanceof MeshStandardMaterial) this.full.set(full.name, full);
    for (const material of this.made.values()) {
      const full = this.full.get(material.name);
      if (full) refine(material, full);
    }
  }

  dispose(): void {
    for (const material of [...this.made.values(), ...this.full.values()]) {
      for (const picture of PICTURES) material[picture]?.dispose();
      material.dispose();
    }
  }

  /**
   * Let the shader draw greys for the tint, and write a share of the colour, with that share as coverage, where a material
   * is thinned: what lies in front of the ground is not seen through.
   */
  private patch(material: MeshStandardMaterial, share: number | null): void {
    if (share !== null) material.blending = NoBlending;
    const thinned = share === null ? "" : `gl_FragColor *= ${share.toFixed(3)};`;
    material.onBeforeCompile = (shader) => {
      shader.uniforms["grey"] = this.grey;
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", "#include <common>\nuniform float grey;")
        .replace(
          "#include <map_fragment>",
          "#include <map_fragment>\n" +
            "diffuseColor.rgb = mix(diffuseColor.rgb, " +
            "vec3(0.5 + 0.5 * sqrt(dot(diffuseColor.rgb, vec3(0.2126, 0.7152, 0.0722)))), grey);",
        )
        .replace(
          "#include <emissivemap_fragment>",
          "#include <emissivemap_fragment>\ntotalEmissiveRadiance += 0.25 * grey * diffuseColor.rgb;", // colours in shade
        )
        .replace("#include <dithering_fragment>", `#include <dithering_fragment>\n${thinned}`);
    };
    material.customProgramCacheKey = () => thinned;
  }
}

function refine(material: MeshStandardMaterial, full: MeshStandardMaterial): void {
  for (const picture of PICTURES) {
    if (material[picture] === full[picture]) continue;
    material[picture]?.dispose();
    material[picture] = full[picture];
    if (full[picture]) full[picture].anisotropy = ANISOTROPY;
  }
  material.color.copy(full.color);
  material.roughness = full.roughness;
  material.metalness = full.metalness;
  material.needsUpdate = true;
}
