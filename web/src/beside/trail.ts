/** The way that a walker has come, in pieces that are coloured by motion model. Pure. */

import type { Vector3 } from "../frames";
import { length, minus } from "./between";

/** A piece of the way. */
export interface Piece {
  /** Which of the places for pieces it takes: the oldest piece's, when there are no free ones. */
  readonly slot: number;
  readonly from: Vector3;
  readonly to: Vector3;
  readonly motionModel: string | null;
}

/** Points closer than this tell nothing new. */
const STEP_M = 0.2;
/** A jump longer than this is a seek or a restart, not a walk (as on the console). */
const JUMP_M = 20;

export class Trail {
  private last: Vector3 | null = null;
  private made = 0;

  /** `most` is how many pieces are kept. */
  constructor(private readonly most: number) {}

  /** How many pieces there are. */
  get pieces(): number {
    return Math.min(this.made, this.most);
  }

  /** Go on to a place; return the piece that leads there, if it is a new one. */
  add(place: Vector3, motionModel: string | null): Piece | null {
    const from = this.last;
    const step_m = from === null ? 0 : length(minus(place, from));
    if (from !== null && step_m < STEP_M) return null;
    this.last = place;
    if (from === null || step_m > JUMP_M) return null;
    const slot = this.made % this.most;
    this.made += 1;
    return { slot, from, to: place, motionModel };
  }

  /** Begin anew: after a seek nobody has walked here yet. */
  clear(): void {
    this.last = null;
    this.made = 0;
  }
}
