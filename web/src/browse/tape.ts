/** A measuring tape: two points on the model, and how far they are apart. The points are pure, the rest three.js and DOM. */

import { Group, Mesh, MeshBasicMaterial, SphereGeometry } from "three";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { element, tell } from "../dom";
import type { Vector3 } from "../frames";
import { say, sayLength } from "../language/speech";
import { lengthsOf, type Span } from "./span";
import type { World } from "./world";

const COLOUR = 0xffd75e;
const KNOB_M = 0.006;

export class Tape {
  isOn = false;
  private span: Span = [];
  private readonly shown = new Group();
  private readonly line = new Line2(
    new LineGeometry(),
    new LineMaterial({ color: COLOUR, linewidth: 3, depthTest: false, toneMapped: false, fog: false }),
  );
  private readonly knobs = [0, 1].map(
    () =>
      new Mesh(new SphereGeometry(1, 16, 8), new MeshBasicMaterial({ color: COLOUR, depthTest: false, fog: false })),
  );
  private readonly words = document.createElement("p");

  constructor(
    private readonly world: World & { pointOf(place: Vector3): readonly [number, number] | null },
    private readonly say: (text: string | null) => void,
  ) {
    this.words.className = "panel";
    this.words.hidden = true;
    element("marks", HTMLElement).append(this.words);
    this.shown.add(this.line, ...this.knobs);
    this.shown.traverse((part) => {
      part.renderOrder = 10;
      part.frustumCulled = false;
    });
    world.eachPicture(() => this.place());
  }

  /** Take the tape in the hand, or put it away. */
  toggle(): void {
    this.isOn = !this.isOn;
    document.body.classList.toggle("measuring", this.isOn);
    element("tape", HTMLButtonElement).setAttribute("aria-pressed", String(this.isOn));
    this.put([]);
    this.say(this.isOn ? say("tape.first") : null);
  }

  /** Take a point; the third one begins anew. */
  click(point: Vector3): void {
    this.put(this.span.length === 1 ? [...this.span, point] : [point]);
    if (this.span.length === 1) this.say(say("tape.second"));
    const lengths = lengthsOf(this.span);
    if (!lengths) return;
    const [far, level, high] = [lengths.far_m, lengths.level_m, Math.abs(lengths.high_m)].map((m) =>
      sayLength(m, "meter", 2),
    );
    this.say(say("tape.result", { far: far ?? "", level: level ?? "", high: high ?? "" }));
  }

  private put(span: Span): void {
    this.span = span;
    const [from, to] = span;
    if (from) this.world.guests.add(this.shown);
    else this.shown.removeFromParent();
    if (from) this.line.geometry.setPositions([...from, ...(to ?? from)]);
    this.knobs.forEach((knob, i) => {
      const at = span[i];
      knob.visible = at !== undefined;
      if (at) knob.position.set(...at);
    });
    const lengths = lengthsOf(span);
    tell(this.words, lengths ? sayLength(lengths.far_m, "meter", 2) : null);
    this.world.ask();
  }

  /** Keep the knobs as large on the screen, and the words over the middle. */
  private place(): boolean {
    const [from, to] = this.span;
    if (!from) return false;
    const { camera } = this.world;
    for (const knob of this.knobs) {
      const far_m = knob.getWorldPosition(knob.position.clone()).distanceTo(camera.position);
      knob.scale.setScalar(Math.max(0.01, KNOB_M * far_m));
    }
    if (!to) return false;
    const middle: Vector3 = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2];
    const at = this.world.pointOf(middle);
    this.words.hidden = at === null;
    if (at) {
      this.words.style.left = `${at[0]}px`;
      this.words.style.top = `${at[1]}px`;
    }
    return false;
  }
}
