/** What lies where on the screen: rays through the window and between places, over a drawn square. three.js only. */

import { type PerspectiveCamera, Raycaster, Vector3 as Vector, Vector2 } from "three";
import type { Vector3 } from "../frames";
import type { Square } from "../model";

export class Rays {
  readonly caster = new Raycaster();

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly canvas: HTMLCanvasElement,
  ) {}

  /** Return the ray through a point of the window. */
  through({ clientX, clientY }: { readonly clientX: number; readonly clientY: number }): Raycaster {
    this.camera.updateMatrixWorld();
    const { clientWidth, clientHeight } = this.canvas;
    this.caster.setFromCamera(
      new Vector2((2 * clientX) / clientWidth - 1, 1 - (2 * clientY) / clientHeight),
      this.camera,
    );
    return this.caster;
  }

  /** Return the point of the window where a place is drawn, pixels; null where it lies behind. */
  pointOf([e, n, u]: Vector3): readonly [number, number] | null {
    const at = new Vector(e, u, -n).project(this.camera);
    if (at.z > 1) return null;
    return [((at.x + 1) / 2) * this.canvas.clientWidth, ((1 - at.y) / 2) * this.canvas.clientHeight];
  }

  /** Return how far one sees in a square from a place towards another, metres; infinite where nothing stands between. */
  reach(square: Square, [e, n, u]: Vector3, [e1, n1, u1]: Vector3): number {
    const { caster } = this;
    const [from, way] = [new Vector(e, u, -n), new Vector(e1 - e, u1 - u, n - n1)];
    caster.far = way.length();
    caster.set(from, way.normalize());
    const hit = square.hit(caster);
    caster.far = Number.POSITIVE_INFINITY;
    return hit ? hit.distanceTo(from) : Number.POSITIVE_INFINITY;
  }
}
