/** The lights of a model: the sun with its shadows, and the sky. three.js only. */

import { AmbientLight, DirectionalLight, HemisphereLight, type Object3D, Vector3 } from "three";
import { T_gltf_site, transform } from "./frames";
import { TO_SUN } from "./sky";
import { type Daylight, daylight, directionOf, type Sun } from "./sun";

const SHADOW_MAP_PX = 2048;
/** Half the side of the square that the sun's shadows cover, metres. */
const SHADOW_REACH_M = 130;
/** The middle of what is lit, gltf axes. */
const MIDDLE = new Vector3(-25, 0, 10);
const DISTANCE_M = 200;
/** In the shade the ground keeps this share of the darkness that the sun's absence alone would make: other things give light, too. */
const DARKEST = 0.85;

export class Sunlight {
  readonly objects: readonly Object3D[];
  /** How much darker the real ground is in a shadow of the model, 0 to 1. */
  shade = 0.55;
  private readonly sun = new DirectionalLight(0xfff1dc, 2.6);
  private readonly sky = new HemisphereLight(0xcfe3ff, 0xb59a78, 1.15);
  private readonly everywhere = new AmbientLight(0xffffff, 0.12);

  constructor() {
    const { sun } = this;
    sun.target.position.copy(MIDDLE);
    sun.target.updateMatrixWorld();
    sun.castShadow = true;
    sun.shadow.mapSize.set(SHADOW_MAP_PX, SHADOW_MAP_PX);
    sun.shadow.bias = -0.0006;
    sun.shadow.normalBias = 0.08;
    const { camera } = sun.shadow;
    camera.left = camera.bottom = -SHADOW_REACH_M;
    camera.right = camera.top = SHADOW_REACH_M;
    [camera.near, camera.far] = [20, 420];
    this.turn(TO_SUN);
    this.objects = [sun, this.sky, this.everywhere];
  }

  /** Whether things throw shadows. */
  set shadows(on: boolean) {
    this.sun.castShadow = on;
  }

  /** Light the model by a sun at this place of the sky. */
  shine(at: Sun): void {
    this.turn(new Vector3(...transform(T_gltf_site, directionOf(at))));
    const light = daylight(at.elevation_rad);
    this.sun.color.setRGB(...light.sunColour);
    this.sun.intensity = light.sunStrength;
    this.sky.color.setRGB(...light.skyColour);
    this.sky.intensity = light.skyStrength;
    this.everywhere.intensity = 0.1 * light.skyStrength;
    this.shade = shadeOf(light, at.elevation_rad);
  }

  dispose(): void {
    this.sun.dispose();
  }

  private turn(toSun: Vector3): void {
    this.sun.position.copy(toSun).multiplyScalar(DISTANCE_M).add(MIDDLE);
    this.sun.updateMatrixWorld();
  }
}

/** Return the sun's own share of the light on level ground, as far as its loss is seen. */
function shadeOf({ sunStrength, skyStrength }: Daylight, elevation_rad: number): number {
  const direct = sunStrength * Math.max(0, Math.sin(elevation_rad));
  return (DARKEST * direct) / (direct + skyStrength);
}
