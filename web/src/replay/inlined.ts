/** A walk that is in the page itself, and plays without any server: see `server/reviewing/exported.py`. */

import { languages } from "../language/speech";
import { clampSeek, type Request } from "../playback";
import { fields, list, number, type Session, text_ } from "../protocol";
import { parseSite, type Site } from "../site";
import { indexAt } from "./keys";
import { type Course, parseCourse, parseTimeline, type Timeline } from "./review";
import type { Listener, Source } from "./source";

const EVERY_MS = 15;

export class Inlined implements Source {
  readonly isServed = false;
  readonly name: string;
  private readonly facts: Readonly<Record<string, unknown>>;
  /** Each frame message in base64. */
  private readonly frames: readonly string[];
  private readonly positions_s: readonly number[];
  private readonly duration_s: number;
  private readonly estimator: string;
  private readonly utcOffset_s: number | null;
  private listener: Listener | null = null;
  private playback = { playing: true, position_s: 0, speed: 1, looping: true };
  private shown = -1;
  private before_ms = 0;

  /** `facts` and `frames` are the texts of the page's two data blocks. */
  constructor(facts: string, frames: string) {
    this.facts = fields(JSON.parse(facts), "walk");
    this.frames = frames.split("\n");
    this.name = text_(this.facts["name"], "");
    this.estimator = text_(this.facts["estimator"], "");
    const offset_s = this.facts["utc_offset_s"];
    this.utcOffset_s = typeof offset_s === "number" ? offset_s : null;
    this.duration_s = number(this.facts["duration_s"], 0);
    this.positions_s = list(this.facts["positions_s"]).map((entry) => number(entry, 0));
  }

  start(listener: Listener): void {
    this.listener = listener;
    listener.connection("open");
    listener.session(this.session);
    this.before_ms = performance.now();
    window.setInterval(() => this.turn(performance.now()), EVERY_MS);
  }

  ask({ action, value }: Request): void {
    if (action === "play") {
      const atEnd = this.shown >= this.frames.length - 1;
      this.change({ playing: true, ...(atEnd ? { position_s: 0 } : {}) });
    } else if (action === "pause") this.change({ playing: false });
    else if (action === "seek") this.change({ position_s: clampSeek(Number(value), this.duration_s) });
    else if (action === "speed") this.change({ speed: Number(value) });
    else if (action === "loop") this.change({ looping: value === true });
  }

  done(): void {}

  async site(): Promise<Site> {
    return parseSite(this.facts["site"], languages(navigator.languages));
  }

  async timeline(): Promise<Timeline> {
    return { ...parseTimeline(this.facts["timeline"]), pictures_s: this.positions_s };
  }

  async thumbnails(): Promise<ImageBitmap | null> {
    const url = this.facts["thumbnails"];
    return typeof url === "string" ? createImageBitmap(await (await fetch(url)).blob()) : null;
  }

  async course(estimator: string): Promise<Course> {
    const course = this.facts["course"];
    if (estimator !== this.estimator || typeof course !== "object" || course === null) throw new Error("");
    return parseCourse(course);
  }

  private get session(): Session {
    return {
      name: this.name,
      title: null,
      kind: "replay",
      log: this.name,
      duration_s: this.duration_s,
      estimator: this.estimator,
      estimators: [this.estimator],
      unavailable: {},
      playback: { ...this.playback },
      anchor: "site",
      utc_offset_s: this.utcOffset_s,
      notice: null,
      health: {},
      sharing: false,
      connected: true,
    };
  }

  private change(changes: Partial<typeof this.playback>): void {
    this.playback = { ...this.playback, ...changes };
    this.listener?.session(this.session);
    this.show();
  }

  private turn(now_ms: number): void {
    const passed_s = (now_ms - this.before_ms) / 1000;
    this.before_ms = now_ms;
    if (!this.playback.playing) return;
    this.playback.position_s += passed_s * this.playback.speed;
    if (this.playback.position_s < this.duration_s) this.show();
    else if (this.playback.looping) this.change({ position_s: 0 });
    else this.change({ playing: false, position_s: this.duration_s });
  }

  /** Tell the picture of the place, if it is another one. */
  private show(): void {
    const index = Math.max(0, indexAt(this.positions_s, this.playback.position_s));
    const frame = this.frames[index];
    if (index === this.shown || frame === undefined) return;
    this.shown = index;
    this.listener?.picture(bytesOf(frame));
  }
}

function bytesOf(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) bytes[index] = text.charCodeAt(index);
  return bytes.buffer;
}
