/**
 * How much is drawn: as much as keeps up with the pictures. Pure; times are milliseconds.
 *
 * It starts low where there is no graphics card, goes up a step while there is time to spare, and down when a step is too slow.
 * A step that was too slow is tried again later, each time after twice as long.
 */

export interface Effort {
  readonly name: string;
  /** Pixels of the model's drawing for one of the screen, along each side. */
  readonly fineness: number;
  /** Samples a pixel: smooth edges. */
  readonly samples: number;
  /** Surfaces lit at their corners, without relief and gloss. */
  readonly plain: boolean;
  readonly shadows: boolean;
  readonly occluders: boolean;
  /** Whether the edges of what hides the model are softened. */
  readonly soft: boolean;
  /** Whether what is no monument is drawn: hills, and what grows on them. */
  readonly landscape: boolean;
  /** The finest level of the model that is drawn near by: 0 is the finest of all. */
  readonly finest: number;
}

/** Of whatever levels there are. */
export const COARSEST = Number.POSITIVE_INFINITY;

const FIRST: Effort = {
  name: "first paint",
  fineness: 0.36,
  samples: 0,
  plain: true,
  shadows: false,
  occluders: false,
  soft: false,
  landscape: false,
  finest: COARSEST,
};

/** What all but the first paint have. */
const WHOLE: Effort = { ...FIRST, occluders: true, landscape: true, fineness: 0.5 };

/** From the cheapest to the best. */
export const EFFORTS: readonly Effort[] = [
  FIRST,
  { ...WHOLE, name: "occluders" },
  { ...WHOLE, name: "shadows", shadows: true, finest: 1 },
  { ...WHOLE, name: "soft edges", shadows: true, finest: 1, soft: true, fineness: 0.75 },
  { ...WHOLE, name: "surfaces", shadows: true, finest: 1, soft: true, fineness: 1, plain: false },
  { ...WHOLE, name: "full", shadows: true, finest: 0, soft: true, fineness: 1, plain: false, samples: 4 },
];

/** Slower than this, p50, a step is left: pictures come at 25 a second. */
const SLOW_MS = 38;
/** Twice as slow as this is left at once. */
const AWFUL_MS = 80;
/** Faster than this there is time for the next step. */
const SPARE_MS = 30;
const LOOKED_AT = 8;
const FIRST_PATIENCE_MS = 20_000;
const MOST_PATIENCE_MS = 640_000;

export class Quality {
  private index: number;
  private times_ms: number[] = [];
  private readonly barred: { until_ms: number; patience_ms: number }[] = EFFORTS.map(() => ({
    until_ms: Number.NEGATIVE_INFINITY,
    patience_ms: FIRST_PATIENCE_MS,
  }));

  /** `inSoftware`: there is no graphics card. */
  constructor(inSoftware: boolean) {
    this.index = inSoftware ? 0 : EFFORTS.length - 1;
  }

  get effort(): Effort {
    return EFFORTS[this.index] ?? FIRST;
  }

  /** The middle of the last times at this step; null before there are enough. */
  get usual_ms(): number | null {
    if (this.times_ms.length < LOOKED_AT) return null;
    return [...this.times_ms].sort((a, b) => a - b)[LOOKED_AT >> 1] ?? null;
  }

  /** Take note of how long a picture took from its arrival to its last pixel; true where the step changes. */
  drawn(took_ms: number, now_ms: number): boolean {
    this.times_ms.push(took_ms);
    if (this.times_ms.length > LOOKED_AT) this.times_ms.shift();
    const usual = this.usual_ms;
    if (usual === null) return false;
    if (usual > SLOW_MS && this.index > 0) {
      this.bar(now_ms);
      return this.go(usual > AWFUL_MS ? -2 : -1);
    }
    const next = this.barred[this.index + 1];
    return usual < SPARE_MS && next !== undefined && now_ms >= next.until_ms ? this.go(1) : false;
  }

  /** Stay at one step, whatever it costs. */
  static fixed(name: string): Quality | null {
    const index = EFFORTS.findIndex((effort) => effort.name === name);
    if (index < 0) return null;
    const quality = new Quality(false);
    quality.index = index;
    quality.drawn = () => false;
    return quality;
  }

  private bar(now_ms: number): void {
    const barred = this.barred[this.index];
    if (!barred) return;
    barred.until_ms = now_ms + barred.patience_ms;
    barred.patience_ms = Math.min(2 * barred.patience_ms, MOST_PATIENCE_MS);
  }

  private go(steps: number): true {
    this.index = Math.min(EFFORTS.length - 1, Math.max(0, this.index + steps));
    this.times_ms = [];
    return true;
  }
}
