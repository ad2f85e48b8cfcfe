/** One named thing of a model at one level: what is known of it, and how it is shown, hidden and tinted. */

import { Box3, Color } from "three";
import { type Evidence, parseEvidence } from "./evidence";
import { groupOf } from "./levels";

/** What a file says of a node. */
export type Extras = Readonly<Record<string, unknown>>;

/** Something that is drawn for a thing. */
export interface Part {
  show(visible: boolean): void;
  /** Multiply its colours. */
  tint(colour: Color): void;
}

const WHITE = new Color(1, 1, 1);

export class Thing {
  /** Null for what is no monument, nor part of one. */
  readonly monument: string | null;
  readonly group: string;
  readonly role: string;
  readonly evidence: Evidence | null;
  readonly source: string | null;
  readonly variant: string | null;
  /** gltf axes, metres. */
  readonly box = new Box3();
  readonly parts: Part[] = [];

  constructor(
    readonly name: string,
    extras: Extras,
  ) {
    this.monument = text(extras["monument"]);
    this.group = groupOf(name, this.monument);
    this.role = text(extras["role"]) ?? "building";
    this.evidence = parseEvidence(extras["evidence"]);
    this.source = text(extras["source"]);
    this.variant = text(extras["variant"]);
  }

  get isGround(): boolean {
    return this.role === "ground";
  }

  show(visible: boolean): void {
    for (const part of this.parts) part.show(visible);
  }

  /** Tint it; null leaves its colours as they are. */
  tint(colour: Color | null): void {
    for (const part of this.parts) part.tint(colour ?? WHITE);
  }
}

function text(value: unknown): string | null {
  return typeof value === "string" && value !== "" ? value : null;
}
