/** The materials of a square, one for each name however many files it comes in; small textures at first, full ones later. */

import { type Material, MeshStandardMaterial, NoBlending, type ShaderMaterial, type Texture } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type Common, plainOf, relook } from "./plain";

const PICTURES = ["map", "normalMap", "roughnessMap", "metalnessMap"] as const;

export class Surfaces {
  /** Of the full textures, as far as they have not come yet. */
  anisotropy = 1;
  private readonly made = new Map<string, MeshStandardMaterial>();
  private readonly common: Common = { grey: { value: 0 }, shade: { value: 0.55 } };
  /** Full surfaces and their plain likenesses, both ways. */
  private readonly plain = new Map<MeshStandardMaterial, ShaderMaterial>();
  private readonly fullOf = new Map<Material, MeshStandardMaterial>();
  private full = new Map<string, MeshStandardMaterial>();

  /** `groundShare` is how much of the ground is drawn: 1 hides the real one. */
  constructor(private readonly groundShare: number) {}

  set tinted(on: boolean) {
    this.common.grey.value = on ? 1 : 0;
  }

  /** How much darker the real ground is where the model's shadow falls, 0 to 1. */
  set shade(share: number) {
    this.common.shade.value = share;
  }

  /** Return the surface to wear in place of this one: its plain likeness, or the full one. */
  worn(now: Material | Material[], plain: boolean): Material | Material[] {
    if (Array.isArray(now)) return now;
    const full = this.fullOf.get(now) ?? now;
    return plain && full instanceof MeshStandardMaterial ? (this.plain.get(full) ?? full) : full;
  }

  /** Return the shared material of that name; `loaded` as it came is the first of its kind. */
  of(loaded: Material, ground: boolean): Material {
    if (!(loaded instanceof MeshStandardMaterial)) return loaded;
    const key = `${loaded.name}${ground ? " (ground)" : ""}`;
    let material = this.made.get(key);
    if (!material) {
      material = loaded.clone();
      const share = ground ? this.groundShare : 1;
      this.patch(material, share);
      const plain = plainOf(material, share, this.common);
      this.plain.set(material, plain);
      this.fullOf.set(plain, material);
      this.made.set(key, material);
      const full = this.full.get(loaded.name);
      if (full) this.retouch(material, full);
    }
    return material;
  }

  /** Take the full textures from a file of materials, one after the other: `taken` is waited for before the next. */
  async refine(gltf: GLTF, taken: (pictures: readonly Texture[]) => Promise<void>): Promise<void> {
    const materials = (await gltf.parser.getDependencies("material")) as Material[];
    for (const full of materials) if (full instanceof MeshStandardMaterial) this.full.set(full.name, full);
    for (const material of [...this.made.values()]) {
      const full = this.full.get(material.name);
      if (!full) continue;
      this.retouch(material, full);
      await taken(PICTURES.flatMap((picture) => material[picture] ?? []));
    }
  }

  private retouch(material: MeshStandardMaterial, full: MeshStandardMaterial): void {
    refine(material, full, this.anisotropy);
    const plain = this.plain.get(material);
    if (plain) relook(plain, material);
  }

  dispose(): void {
    for (const plain of this.plain.values()) plain.dispose();
    for (const material of [...this.made.values(), ...this.full.values()]) {
      for (const picture of PICTURES) material[picture]?.dispose();
      material.dispose();
    }
  }

  /**
   * Let the shader draw greys for the tint, and write a share of the colour, with that share as coverage, where a material
   * is thinned: what lies in front of the ground is not seen through. Where the model's shadow falls on thinned ground,
   * darkness covers the real one.
   */
  private patch(material: MeshStandardMaterial, share: number): void {
    if (share < 1) material.blending = NoBlending;
    const thinned = share < 1 ? THINNED.replaceAll("SHARE", share.toFixed(3)) : "";
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.common);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", "#include <common>\nuniform float grey; uniform float shade;")
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

/** After the loop over the lights, the last direct light is the sun's, its shadow taken off. */
const THINNED = /* glsl */ `
  float seen = 1.0;
  #if NUM_DIR_LIGHTS > 0
    seen = clamp(directLight.color.r / max(directionalLights[0].color.r, 1e-4), 0.0, 1.0);
  #endif
  gl_FragColor = vec4(gl_FragColor.rgb * SHARE, SHARE + (1.0 - SHARE) * shade * (1.0 - seen));`;

function refine(material: MeshStandardMaterial, full: MeshStandardMaterial, anisotropy: number): void {
  for (const picture of PICTURES) {
    if (material[picture] === full[picture]) continue;
    material[picture]?.dispose();
    material[picture] = full[picture];
    if (full[picture]) full[picture].anisotropy = anisotropy;
  }
  material.color.copy(full.color);
  material.roughness = full.roughness;
  material.metalness = full.metalness;
  material.needsUpdate = true;
}
