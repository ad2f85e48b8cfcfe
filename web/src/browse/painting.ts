/** The picture of the square: one epoch over the other, what stands still kept, and who is there before it. three.js only. */

import { type PerspectiveCamera, Vector4, type WebGLRenderer } from "three";
import type { Square } from "../model";
import type { Readying } from "../readying";
import type { Sky } from "../sky";
import { Guests } from "./guests";
import { Still } from "./still";
import { Veil } from "./veil";

/** A square as it is drawn. */
export interface Layer {
  readonly square: Square;
  readonly sky: Sky;
  /** Whether its shadows are to be drawn anew, and whether they ever were. */
  stale: boolean;
  thrown: boolean;
  plain: boolean;
  /** Whether its finest surfaces can be drawn at once. */
  finest: "no" | "soon" | "yes";
}

export interface Cost {
  readonly calls: number;
  readonly triangles: number;
}

export class Painting {
  readonly guests = new Guests();
  /** Of the squares as they were drawn last, shadows left out. */
  cost: Cost = { calls: 0, triangles: 0 };
  /** Whether there is no time for shadows: they cost as much as all else, and the old ones stay. */
  isHurried = false;
  private readonly veil = new Veil();
  private readonly still = new Still();

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly camera: PerspectiveCamera,
  ) {}

  /** Compile what is not drawn with yet, but may be soon. */
  async ready(readying: Readying): Promise<void> {
    for (const { quad } of [this.still, this.veil]) await readying.compile(quad.scene, quad.camera);
  }

  /** What stood still is no longer as it was. */
  forget(): void {
    this.still.forget();
  }

  /** Draw one square; `stands` says that the next pictures will hardly be another view of it. */
  drawOne(layer: Layer, stands: boolean): void {
    if (stands || this.still.isKept) this.drawStill(layer);
    else this.cost = this.paint(layer);
    this.guests.draw(this.renderer, this.camera, layer.square.scene);
  }

  /** Draw two squares, the one of which most is shown last: its depth is what hides who is there. `part` of each side is drawn to. */
  drawBoth(most: Layer, least: Layer, shareOfLeast: number, part: number): void {
    const { renderer, veil } = this;
    const first = this.paint(least);
    if (shareOfLeast > 0) veil.take(renderer);
    const second = this.paint(most);
    if (shareOfLeast > 0) veil.draw(renderer, shareOfLeast, part);
    this.cost = { calls: first.calls + second.calls, triangles: first.triangles + second.triangles };
    this.guests.draw(renderer, this.camera, most.square.scene);
  }

  private drawStill(layer: Layer): void {
    const { renderer, still } = this;
    if (!still.isKept) {
      const { z, w } = renderer.getCurrentViewport(new Vector4());
      still.take(renderer, z, w, () => {
        this.cost = this.paint(layer);
      });
    }
    still.draw(renderer);
  }

  private paint(layer: Layer): Cost {
    const { renderer, camera } = this;
    if (layer.square.update(camera.position)) layer.stale = true;
    const throwsAnew = layer.stale && !(this.isHurried && layer.thrown);
    renderer.shadowMap.needsUpdate = throwsAnew;
    if (throwsAnew) {
      layer.stale = false;
      layer.thrown = true;
    }
    // the sky is drawn first, after the shadows
    layer.sky.mesh.onBeforeRender = () => renderer.info.reset();
    renderer.clear();
    renderer.render(layer.square.scene, camera);
    const { calls, triangles } = renderer.info.render;
    return { calls, triangles };
  }
}
