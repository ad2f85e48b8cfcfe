/** Alignment on the page: a tap in the picture and the landmark that it means, a drag, or a place on the plan. DOM only. */

import {
  type Alignment,
  adviceFor,
  candidates,
  draggedPose,
  hereSigma,
  improvementWords,
  sightOf,
  tapSigma,
} from "./alignment";
import type { Doubt } from "./certainty";
import { Crosshair } from "./crosshair";
import { element, tell } from "./dom";
import type { Matrix4, Vector3 } from "./frames";
import { headingOf } from "./frames";
import { say } from "./language/speech";
import { told } from "./language/told";
import type { Pair } from "./lens";
import { SiteMap } from "./map";
import { pixelAt, placeOf } from "./picture";
import type { Place } from "./plan";
import type { Reply } from "./protocol";
import type { Landmark, Site } from "./site";
import type { FrameMessage } from "./wire";
import { metresText } from "./words";

/** What the page does for an alignment. */
export interface Host {
  /** The picture that is drawn now. */
  readonly frame: FrameMessage | null;
  readonly doubt: Doubt | null;
  /** Ask the rig; null where there is no connection, else the request's name. */
  align(alignment: Alignment): string | null;
  /** Draw the present picture again with another pose; null for its own. */
  preview(T_site_cam: Matrix4 | null): void;
  /** The point of the drawn model in that direction from the present eye; null where it has none. */
  modelPoint(sight: Vector3): Vector3 | null;
  announce(text: string): void;
}

/** A pointer that moves less than this is a tap, pixels of the page. */
const STILL_PX = 9;
/** Where nothing of the model is dragged, what is so far away is: it turns the view and moves nobody. */
const FAR_M = 200;
/** Corrections are faded in; so long after one the doubt is what it has become. */
const SETTLED_NS = 4_000_000_000;
/** Landmarks that are offered first. */
const FIRST = 4;
/** Half the side of the plan on which a visitor shows a place, metres. */
const NEAR_M = 45;

interface Sent {
  readonly request: string;
  readonly before: Doubt | null;
  readonly words: string;
}

/** A word that was taken, until its correction is faded in. */
interface Settling {
  readonly before: Doubt;
  /** Capture of the first picture after it. */
  t_ns: number | null;
}

export class Align {
  private on = false;
  private landmarks: readonly Landmark[] = [];
  private outlines: readonly (readonly Place[])[] = [];
  /** Where the pointer went down, and in which picture. */
  private down: { readonly at: Pair; readonly pixel: Pair; readonly frame: FrameMessage; dragged: boolean } | null =
    null;
  private tap: { readonly pixel: Pair; readonly sigma_px: number; readonly frame: FrameMessage } | null = null;
  private sent: Sent | null = null;
  private settling: Settling | null = null;
  private bearings_rad: number[] = [];
  private readonly panel = element("aligning", HTMLElement);
  private readonly words = element("align-words", HTMLElement);
  private readonly choices = element("choices", HTMLElement);
  private readonly stand = element("stand", HTMLElement);
  private readonly mark = element("mark", HTMLElement);
  private readonly button = element("align", HTMLButtonElement);
  private readonly crosshair: Crosshair;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly host: Host,
  ) {
    this.crosshair = new Crosshair(canvas, this.mark, (at) => this.tapAt(at));
    this.button.onclick = () => this.turn(!this.on);
    element("aligned", HTMLButtonElement).onclick = () => this.turn(false);
    element("here", HTMLButtonElement).onclick = () => this.offerPlan();
    element("take-back", HTMLButtonElement).onclick = () => this.send({ kind: "undo" }, say("align.taken_back"));
    canvas.addEventListener("pointerdown", (event) => this.pressed(event));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.released(event));
    canvas.addEventListener("pointercancel", () => this.rest());
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey, altKey, target }) => {
      if (ctrlKey || metaKey || altKey || target instanceof HTMLSelectElement) return;
      if (key === "a") this.turn(!this.on);
      else if (key === "Escape" && this.on) {
        if (this.tap !== null || !this.stand.hidden) this.rest();
        else this.turn(false);
      }
    });
  }

  /** Whether the visitor looks for landmarks, which the square must not hide. */
  get active(): boolean {
    return this.on;
  }

  /** Whether the picture is held: somebody points at something in it. */
  get holds(): boolean {
    return this.down !== null || this.tap !== null || this.crosshair.isMoving;
  }

  /** Take what the site has to point at. */
  learn(site: Site): void {
    this.landmarks = site.landmarks;
    this.outlines = site.monuments.map(({ footprint }) => footprint).filter((footprint) => footprint.length > 2);
  }

  /** Take the rig's answer. */
  replied({ requestId, ok, error }: Reply): boolean {
    if (this.sent?.request !== requestId) return false;
    const sent = this.sent;
    this.sent = null;
    if (ok) this.host.announce(sent.words);
    else this.host.announce(error === null ? say("align.refused") : told(error));
    if (ok && sent.before !== null) this.settling = { before: sent.before, t_ns: null };
    return true;
  }

  /** Take note of a picture that was drawn: once the last word has settled, tell what it has brought. */
  drawn(frame: FrameMessage): void {
    const settling = this.settling;
    if (settling === null || this.host.doubt === null) return;
    settling.t_ns ??= frame.t_capture_ns; // the first picture since: the one that was pointed at may be old
    const since_ns = frame.t_capture_ns - settling.t_ns;
    if (since_ns >= 0 && since_ns <= SETTLED_NS) return;
    this.settling = null;
    if (since_ns > 0) this.host.announce(improvementWords(settling.before, this.host.doubt));
  }

  private turn(on: boolean): void {
    this.on = on;
    document.body.classList.toggle("aligning", on);
    this.panel.hidden = !on;
    this.button.setAttribute("aria-pressed", String(on));
    this.crosshair.isOn = on;
    this.canvas.tabIndex = on ? 0 : -1;
    this.canvas.setAttribute("role", on ? "application" : "img");
    this.canvas.setAttribute("aria-label", say(on ? "align.canvas" : "ar.canvas"));
    if (on) this.canvas.focus({ preventScroll: true });
    else this.button.focus();
    if (!on) this.bearings_rad = [];
    this.rest();
  }

  /** Back to where a landmark may be tapped. */
  private rest(): void {
    this.down = this.tap = null;
    this.crosshair.rest();
    this.mark.hidden = true;
    this.stand.hidden = true;
    this.choices.replaceChildren();
    this.words.textContent = adviceFor(this.bearings_rad);
    this.host.preview(null);
  }

  // -- in the picture --------------------------------------------------------------------------------------------

  private pressed(event: PointerEvent): void {
    const frame = this.host.frame;
    if (!this.on || frame === null || !event.isPrimary) return;
    this.rest();
    const pixel = this.pixelOf(event, frame);
    if (pixel === null) return;
    this.down = { at: [event.clientX, event.clientY], pixel, frame, dragged: false };
    this.canvas.setPointerCapture(event.pointerId);
  }

  private moved(event: PointerEvent): void {
    const { down } = this;
    if (down === null) return;
    const far = Math.hypot(event.clientX - down.at[0], event.clientY - down.at[1]) > STILL_PX;
    down.dragged ||= far && down.frame.pose !== null && this.host.doubt !== null;
    const to = this.pixelOf(event, down.frame);
    if (down.dragged && to !== null && down.frame.pose !== null)
      this.host.preview(draggedPose(down.frame.lens, down.frame.pose.T_site_cam, down.pixel, to));
  }

  private released(event: PointerEvent): void {
    const { down } = this;
    this.down = null;
    if (down === null) return;
    const pixel = this.pixelOf(event, down.frame) ?? down.pixel;
    const sigma_px = tapSigma(event.pointerType, this.pixelsOf(down.frame));
    if (down.dragged) this.drop(down.frame, down.pixel, pixel, sigma_px);
    else this.offer(down.frame, down.pixel, sigma_px);
  }

  /** Take a point of the window for a tap of somebody who points with keys. */
  private tapAt([clientX, clientY]: Pair): void {
    const { frame } = this.host;
    const pixel = frame && this.pixelOf({ clientX, clientY }, frame);
    this.rest();
    if (frame === null || pixel === null) return;
    this.offer(frame, pixel, tapSigma("mouse", this.pixelsOf(frame)));
    this.choices.querySelector("button")?.focus();
  }

  /** Say that what was drawn at one pixel belongs to another. */
  private drop(frame: FrameMessage, from: Pair, to: Pair, sigma_px: number): void {
    const pose = frame.pose;
    const sight = pose && sightOf(frame.lens, pose.T_site_cam, from);
    if (pose && sight) {
      const [e = 0, n = 0, u = 0] = [3, 7, 11].map((index) => pose.T_site_cam[index]);
      const far: Vector3 = [e + FAR_M * sight[0], n + FAR_M * sight[1], u + FAR_M * sight[2]];
      const point_site_m = this.host.modelPoint(sight) ?? far;
      const tap: Alignment = { kind: "tap", frame_id: frame.frameId, place_px: to, sigma_px, point_site_m };
      if (this.send(tap, say("align.moved"))) this.pointedAt(point_site_m, frame);
    }
    this.rest();
  }

  /** Ask which landmark was tapped. */
  private offer(frame: FrameMessage, pixel: Pair, sigma_px: number): void {
    this.tap = { pixel, sigma_px, frame };
    const [across, down] = placeOf(this.layout(frame), this.aspect, pixel);
    const box = this.canvas.getBoundingClientRect();
    this.mark.style.left = `${box.left + across * box.width}px`;
    this.mark.style.top = `${box.top + down * box.height}px`;
    this.mark.hidden = false;
    this.words.textContent = say(this.landmarks.length > 0 ? "align.which" : "align.no_landmarks");
    const known = frame.pose?.headingKnown ? frame.pose.T_site_cam : null;
    const all = candidates(this.landmarks, pixel, frame.lens, known);
    const buttons = all.map(({ landmark, distance_m }) => {
      const button = document.createElement("button");
      button.type = "button";
      button.dataset["landmark"] = landmark.id;
      button.textContent = landmarkWords(landmark.name, distance_m);
      button.onclick = () => this.choose(landmark);
      return button;
    });
    const rest = buttons.slice(known === null ? buttons.length : FIRST);
    for (const button of rest) button.hidden = true;
    const more = document.createElement("button");
    more.type = "button";
    more.className = "more";
    more.textContent = say("align.another");
    more.hidden = rest.length === 0;
    more.onclick = () => {
      for (const button of rest) button.hidden = false;
      more.hidden = true;
    };
    this.choices.replaceChildren(...buttons, more);
  }

  private choose({ name, point_site_m }: Landmark): void {
    const { tap } = this;
    if (tap === null) return;
    const { frame, pixel, sigma_px } = tap;
    const asked: Alignment = { kind: "tap", frame_id: frame.frameId, place_px: pixel, sigma_px, point_site_m };
    if (this.send(asked, say("align.noted", { name }))) this.pointedAt(point_site_m, frame);
    this.rest();
    this.canvas.focus({ preventScroll: true });
  }

  private pointedAt([e, n]: Vector3, { pose }: FrameMessage): void {
    if (pose === null) return;
    this.bearings_rad.push(Math.atan2(e - (pose.T_site_cam[3] ?? 0), n - (pose.T_site_cam[7] ?? 0)));
  }

  // -- on the plan -------------------------------------------------------------------------------------------------

  private offerPlan(): void {
    this.rest();
    this.words.textContent = say("align.tap_plan");
    this.stand.hidden = false;
    const { frame } = this.host;
    const pose = frame?.pose ?? null;
    const place: Place | null = pose && [pose.T_site_cam[3] ?? 0, pose.T_site_cam[7] ?? 0];
    const map = new SiteMap(this.stand, this.outlines, ([e_m, n_m], metresPerPixel, pointerType) => {
      const sigma_m = hereSigma(pointerType, metresPerPixel);
      this.send({ kind: "here", e_m, n_m, sigma_m }, say("align.stand_there", { length: metresText(sigma_m) }));
      this.rest();
    });
    if (place) map.zoom(place, NEAR_M);
    const half_rad = frame ? Math.atan(frame.lens.width_px / (2 * frame.lens.fx_px)) : 0.5;
    map.show(place, pose?.headingKnown ? headingOf(pose.T_site_cam) : null, half_rad, this.host.doubt);
  }

  // -- common ------------------------------------------------------------------------------------------------------

  private send(alignment: Alignment, words: string): boolean {
    const request = this.host.align(alignment);
    if (request === null) return false;
    const before = alignment.kind === "undo" ? null : this.host.doubt;
    if (alignment.kind === "undo") this.bearings_rad.pop();
    this.settling = null;
    this.sent = { request, before, words };
    tell(this.words, adviceFor(this.bearings_rad));
    return true;
  }

  private get aspect(): number {
    return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
  }

  private layout({ lens, quarterTurns }: FrameMessage): Parameters<typeof pixelAt>[0] {
    return { width_px: lens.width_px, height_px: lens.height_px, quarterTurns };
  }

  private pixelOf({ clientX, clientY }: Pick<PointerEvent, "clientX" | "clientY">, frame: FrameMessage): Pair | null {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return pixelAt(this.layout(frame), this.aspect, [(clientX - left) / width, (clientY - top) / height]);
  }

  /** Return how many pixels of the picture make one of the page. */
  private pixelsOf(frame: FrameMessage): number {
    const layout = this.layout(frame);
    const a = placeOf(layout, this.aspect, [0, 0]);
    const b = placeOf(layout, this.aspect, [100, 0]);
    const { width, height } = this.canvas.getBoundingClientRect();
    return 100 / Math.max(1e-6, Math.hypot((b[0] - a[0]) * width, (b[1] - a[1]) * height));
  }
}

function landmarkWords(name: string, distance_m: number | null): string {
  return distance_m === null ? name : say("align.landmark_far", { name, far: metresText(distance_m) });
}
