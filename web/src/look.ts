/** How the model is made to belong to the picture: the sun's place, the picture's own brightness, and as much effort as it keeps up with. */

import type { Composite } from "./composite";
import type { Picture } from "./decoding";
import { gainFor, Matching } from "./exposure";
import { Meter } from "./meter";
import type { Square } from "./model";
import { type Effort, Quality } from "./quality";
import type { Origin } from "./site";
import { ANCIENT_YEAR, angleBetween, atSolarHour, daylight, type Sun, sunAt } from "./sun";
import type { FrameMessage } from "./wire";

/** What the visitor wants of the sun: as it is, as it was at this hour in antiquity, or a solar hour. */
export type SunWish = "now" | "ancient" | number;

/** Shadows are drawn anew when the sun has moved by as much as it is wide. */
const MOVED_RAD = (0.5 * Math.PI) / 180;
const METERED_EVERY_MS = 200;
const TIMED_EVERY = 4;
/** A picture whose drawing takes less of its time than this was late by its decoding: drawing less would not help. */
const DRAWN_SHARE = 1 / 3;

export class Look {
  square: Square | null = null;
  origin: Origin | null = null;
  /** The true time less this browser's clock, seconds. */
  clockOff_s = 0;
  /** What a picture's stamp needs for the seconds since 1970; null where nobody knows: then it is of now. */
  utcOffset_s: number | null = null;
  sun: Sun | null = null;
  private wish: SunWish = "now";
  private lit: Sun | null = null;
  private message: FrameMessage | null = null;
  private readonly quality: Quality;
  private readonly matching = new Matching();
  private readonly meter = new Meter();
  private metered_ms = Number.NEGATIVE_INFINITY;
  private count = 0;
  private readonly arrivals_ms: number[] = [];
  private timed: { readonly count: number; readonly tell: (arrivals_ms: readonly number[]) => void } | null = null;

  constructor(
    private readonly composite: Composite,
    asked: URLSearchParams,
  ) {
    this.quality = Quality.fixed(asked.get("effort") ?? "") ?? new Quality(composite.drawsInSoftware);
    const sun = asked.get("sun");
    if (sun === "ancient") this.wish = sun;
    else if (sun !== null && sun !== "" && Number.isFinite(Number(sun))) this.wish = Number(sun);
    composite.work(this.effort);
  }

  get effort(): Effort {
    return this.quality.effort;
  }

  get sunWish(): SunWish {
    return this.wish;
  }

  set sunWish(wish: SunWish) {
    this.wish = wish;
    this.light();
  }

  /** Return how long the next pictures take from the arrival of their message to their last pixel, milliseconds. */
  time(count: number): Promise<readonly number[]> {
    this.arrivals_ms.length = 0;
    return new Promise((tell) => {
      this.timed = { count, tell };
    });
  }

  /** Take a model to light. */
  show(square: Square, origin: Origin | null): void {
    [this.square, this.origin, this.lit] = [square, origin, null];
    square.work(this.effort);
    this.light();
  }

  /** Prepare for the picture that is drawn next. */
  before(message: FrameMessage, picture: Picture, now_ms: number): void {
    this.message = message;
    this.light();
    if (now_ms - this.metered_ms < METERED_EVERY_MS) return;
    this.metered_ms = now_ms;
    const mean = this.meter.lightOf(picture);
    if (!mean) return;
    const real = this.sunFor("now");
    this.composite.gain = this.matching.take(gainFor(mean, real ? lightOf(real) / USUAL_LIGHT : 1), now_ms);
  }

  /** Time the picture that was decoded at `began_ms` and drawn just now, and draw more or less from the next on. */
  after(began_ms: number, arrived_ms: number): void {
    this.count += 1;
    if (!this.timed && this.count % TIMED_EVERY !== 0) return;
    this.composite.finish();
    const now_ms = performance.now();
    if (this.timed && this.arrivals_ms.push(now_ms - arrived_ms) >= this.timed.count) {
      this.timed.tell([...this.arrivals_ms]);
      this.timed = null;
    }
    const took_ms = Math.min(now_ms - arrived_ms, (now_ms - began_ms) / DRAWN_SHARE);
    if (!this.square || this.square.isLoading || !this.quality.drawn(took_ms, now_ms)) return;
    this.composite.work(this.effort);
    this.square.work(this.effort);
  }

  get usual_ms(): number | null {
    return this.quality.usual_ms;
  }

  /** Put the sun where it is wished, if it has moved by as much as is seen. */
  private light(): void {
    this.sun = this.sunFor(this.wish);
    if (!this.square || !this.sun || (this.lit && angleBetween(this.sun, this.lit) < MOVED_RAD)) return;
    this.square.shine(this.sun);
    this.lit = this.sun;
  }

  private sunFor(wish: SunWish): Sun | null {
    const { origin, message } = this;
    if (!origin || !message) return null;
    const { utcOffset_s } = this;
    const now_s = utcOffset_s === null ? Date.now() / 1000 + this.clockOff_s : message.t_capture_ns / 1e9 + utcOffset_s;
    const t_s = typeof wish === "number" ? atSolarHour(now_s, origin.lon_deg, wish) : now_s;
    return sunAt(t_s, origin.lat_deg, origin.lon_deg, wish === "now" ? null : ANCIENT_YEAR);
  }
}

/** Return how much light falls on level ground, in no unit. */
function lightOf({ elevation_rad }: Sun): number {
  const { sunStrength, skyStrength } = daylight(elevation_rad);
  return sunStrength * Math.max(0, Math.sin(elevation_rad)) + skyStrength;
}

const USUAL_LIGHT = lightOf({ azimuth_rad: 0, elevation_rad: (62 * Math.PI) / 180 });
