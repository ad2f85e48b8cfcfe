/** The timeline: small pictures, motion models, what happened, and the place in the walk, to be dragged. DOM and a 2-D canvas. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import { clockText } from "../playback";
import { motionColour } from "../words";
import { type Course, type Happening, happeningsAt, modelAt, type Timeline } from "./review";
import { happeningWords, modelWords } from "./told";

/** Small pictures in the strip of the server. */
const COUNT = 24;
/** Of the strip, pixels of the page: the band of motion models, below the pictures. */
const BAND_PX = 6;
/** A mark is found by a pointer this near, seconds for each second of a minute's walk. */
const NEAR_SHARE = 0.004;

export class Strip {
  private readonly root = element("strip", HTMLElement);
  private readonly canvas = element("strip-pictures", HTMLCanvasElement);
  private readonly marks = element("strip-marks", HTMLElement);
  private readonly cursor = element("strip-cursor", HTMLElement);
  private readonly pointed = element("strip-pointed", HTMLElement);
  private readonly seek = element("seek", HTMLInputElement);
  private timeline: Timeline | null = null;
  private course: Course | null = null;
  private pictures: ImageBitmap | null = null;
  private duration_s = 0;
  private dragging = false;
  private told = "";

  /** `go` is called with each place that is wished, also on the way there. */
  constructor(private readonly go: (position_s: number) => void) {
    this.seek.oninput = () => {
      this.dragging = true;
      this.place(Number(this.seek.value));
      this.go(Number(this.seek.value));
    };
    this.seek.onchange = () => {
      this.dragging = false;
      this.go(Number(this.seek.value));
    };
    this.root.onpointermove = (event) => this.point(event);
    this.root.onpointerleave = () => tell(this.pointed, null);
    new ResizeObserver(() => this.draw()).observe(this.root);
  }

  /** Show how long the walk is. */
  last(duration_s: number): void {
    if (duration_s === this.duration_s) return;
    this.duration_s = duration_s;
    this.seek.max = String(duration_s);
    this.mark();
  }

  /** Show what happened. */
  learn(timeline: Timeline): void {
    this.timeline = timeline;
    this.mark();
  }

  /** Show pictures. */
  illustrate(pictures: ImageBitmap | null): void {
    this.pictures = pictures;
    this.root.classList.toggle("bare", pictures === null);
    this.draw();
  }

  /** Show an estimator's motion models. */
  colour(course: Course | null): void {
    this.course = course;
    this.draw();
  }

  /** Show where in the walk the picture is. */
  at(position_s: number): void {
    if (!this.dragging) this.place(position_s);
  }

  private place(position_s: number): void {
    const share = this.duration_s > 0 ? position_s / this.duration_s : 0;
    this.cursor.style.left = `${100 * Math.min(1, share)}%`;
    if (!this.dragging) this.seek.value = String(position_s);
    const text = say("bar.place", { now: clockText(position_s), length: clockText(this.duration_s) });
    if (text === this.told) return;
    this.told = text;
    this.seek.setAttribute("aria-valuetext", text);
  }

  private mark(): void {
    const { timeline, duration_s } = this;
    if (timeline === null || duration_s <= 0) return;
    this.marks.replaceChildren(...timeline.happenings.map((happening) => markOf(happening, duration_s)));
  }

  /** Say what is under the pointer. */
  private point({ clientX, pointerType }: PointerEvent): void {
    const { left, width } = this.root.getBoundingClientRect();
    if (pointerType === "touch" || width <= 0) {
      tell(this.pointed, null);
      return;
    }
    const share = Math.min(1, Math.max(0, (clientX - left) / width));
    const t_s = share * this.duration_s;
    const found = this.timeline ? happeningsAt(this.timeline, t_s, NEAR_SHARE * this.duration_s) : [];
    const model = this.course && modelWords(modelAt(this.course, t_s), this.course.estimator);
    tell(this.pointed, [clockText(t_s), ...found.map(happeningWords), model].filter(Boolean).join(" · "));
    this.pointed.style.left = `clamp(5rem, ${100 * share}%, 100% - 5rem)`;
  }

  private draw(): void {
    const { canvas, pictures, root } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const [width, height] = [root.clientWidth, root.clientHeight];
    if (width === 0 || height === 0) return;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const drawing = canvas.getContext("2d");
    if (!drawing) return;
    drawing.scale(ratio, ratio);
    if (pictures) drawPictures(drawing, pictures, width, height - BAND_PX);
    if (this.course) drawModels(drawing, this.course, this.duration_s, width, height);
  }
}

/** Draw as many pictures as fit side by side, each of its own moment. */
function drawPictures(drawing: CanvasRenderingContext2D, strip: ImageBitmap, width: number, height: number): void {
  const own = strip.width / COUNT;
  const fits = Math.max(1, Math.min(COUNT, Math.round(width / ((own * height) / strip.height))));
  const wide = width / fits;
  // a picture is cut, never stretched
  const cut = Math.min(own, (wide * strip.height) / height);
  for (let index = 0; index < fits; index++) {
    const picture = Math.min(COUNT - 1, Math.floor(((index + 0.5) * COUNT) / fits));
    const x = picture * own + (own - cut) / 2;
    drawing.drawImage(strip, x, 0, cut, strip.height, index * wide, 0, wide + 0.5, height);
  }
}

function drawModels(
  drawing: CanvasRenderingContext2D,
  course: Course,
  duration_s: number,
  width: number,
  height: number,
): void {
  course.models.forEach(([from_s, model], index) => {
    const until_s = course.models[index + 1]?.[0] ?? duration_s;
    drawing.fillStyle = motionColour(model);
    const x = (from_s / duration_s) * width;
    drawing.fillRect(x, height - BAND_PX, Math.max(0.5, ((until_s - from_s) / duration_s) * width), BAND_PX);
  });
}

function markOf(happening: Happening, duration_s: number): HTMLElement {
  const mark = document.createElement("span");
  mark.dataset["kind"] = happening.kind;
  mark.style.left = `${(100 * happening.from_s) / duration_s}%`;
  mark.style.width = `${(100 * (happening.until_s - happening.from_s)) / duration_s}%`;
  return mark;
}
