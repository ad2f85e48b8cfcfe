/** A seeded generator of numbers, so that a failing test fails again. */

import type { Matrix4, Vector3 } from "../../web/src/frames";

export class Random {
  private state: number;

  constructor(seed: number) {
    this.state = seed >>> 0;
  }

  /** Return the next whole number, 0 to 2 ** 32 - 1 (Marsaglia's xorshift over a counter). */
  private next(): number {
    this.state = (this.state + 0x9e3779b9) >>> 0;
    let x = this.state || 1;
    for (let round = 0; round < 3; round++) {
      x ^= x << 13;
      x ^= x >>> 17;
      x ^= x << 5;
      x = Math.imul(x, 0x2545f491) >>> 0 || 1;
    }
    return x >>> 0;
  }

  /** Return a number of [low, high). */
  between(low: number, high: number): number {
    return low + (high - low) * (this.next() / 2 ** 32);
  }

  /** Return a whole number of 0 to end - 1. */
  below(end: number): number {
    return Math.floor(this.between(0, end));
  }

  bytes(length: number): Uint8Array<ArrayBuffer> {
    return Uint8Array.from({ length }, () => this.below(256));
  }

  point(reach: number): Vector3 {
    return [this.between(-reach, reach), this.between(-reach, reach), this.between(-reach, reach)];
  }

  /** Return a rigid transform: a unit quaternion as a matrix, and a place within `reach`. */
  rigid(reach: number): Matrix4 {
    const four = [0, 0, 0, 0].map(() => this.between(-1, 1));
    const length = Math.hypot(...four) || 1;
    const [w = 1, x = 0, y = 0, z = 0] = four.map((value) => value / length);
    const [px, py, pz] = this.point(reach);
    return [
      ...[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), px],
      ...[2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), py],
      ...[2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), pz],
      ...[0, 0, 0, 1],
    ];
  }
}

/** Call `check` with a generator of its own for each of `count` seeds; a failure names its seed. */
export function forSeeds(count: number, check: (random: Random) => void): void {
  for (let seed = 0; seed < count; seed++) {
    try {
      check(new Random(seed));
    } catch (error) {
      throw new Error(`with seed ${seed}: ${String(error)}`, { cause: error });
    }
  }
}
