/** What others put into the square, lit as the square is and drawn after it. three.js only. */

import { type Camera, Group, Scene, type WebGLRenderer } from "three";
import { T_gltf_site } from "../frames";
import { Sunlight } from "../sunlight";

export class Guests {
  /** Site axes. */
  readonly group = new Group();
  readonly light = new Sunlight();
  private readonly scene = new Scene();

  constructor() {
    this.group.matrixAutoUpdate = false;
    this.group.matrix.set(...(T_gltf_site as Parameters<typeof this.group.matrix.set>));
    this.light.shadows = false; // a shadow is drawn seldom: theirs would stay behind
    this.scene.add(this.group, ...this.light.objects);
  }

  /** Draw them into the picture of a square, as far away as that is hazy. */
  draw(renderer: WebGLRenderer, camera: Camera, { fog }: Scene): void {
    this.scene.fog = fog;
    renderer.render(this.scene, camera);
  }
}
