/** The head-mounted display: nothing but the picture, a menu for one button or for the eyes alone, once or for each eye. DOM only. */

import { element } from "./dom";
import { column, headingOf, type Matrix4 } from "./frames";
import { Gaze } from "./gaze";
import { OneButton, type Press } from "./press";

/** One thing that the menu can do; a text that it returns is said. */
export interface Deed {
  readonly words: () => string;
  do(): unknown;
}

/** Between the pupils of most people, millimetres. */
const USUAL_IPD_MM = 63;
const IPD_MM = [0, 80] as const;
const MENU_STAYS_MS = 8000;
const SAID_FOR_MS = 3000;
/** Keys with uses of their own outside. */
const NOT_OURS = new Set(["Escape", "Tab", "F5", "F11", "F12"]);

export interface Wearing {
  readonly eyes: 1 | 2;
  readonly ipd_m: number;
}

/** Return how the address asks for a head-mounted display; null where it does not. */
export function worn(asked: URLSearchParams): Wearing | null {
  if (asked.get("display") !== "hmd") return null;
  const ipd = asked.get("ipd");
  const ipd_mm = ipd === null || ipd === "" || !Number.isFinite(Number(ipd)) ? USUAL_IPD_MM : Number(ipd);
  const [least, most] = IPD_MM;
  return { eyes: asked.get("eyes") === "2" ? 2 : 1, ipd_m: Math.min(most, Math.max(least, ipd_mm)) / 1000 };
}

export class Hmd {
  private readonly button = new OneButton();
  private gaze = new Gaze(0);
  private deeds: readonly Deed[] = [];
  private readonly eyes: readonly Eye[];
  /** What the button is at; null while there is no menu. */
  private at: number | null = null;
  private touched_ms = 0;
  private said = "";
  private said_ms = Number.NEGATIVE_INFINITY;
  private isAwake = false;

  /** `offered`: what the menu holds now; `sayings`: elements whose texts must be seen here, too. */
  constructor(
    wearing: Wearing,
    private readonly offered: () => readonly Deed[],
    private readonly sayings: readonly HTMLElement[],
  ) {
    document.body.classList.add("hmd");
    const place = element("eyes", HTMLElement);
    this.eyes = Array.from({ length: wearing.eyes }, () => new Eye(place));
    place.hidden = false;
    place.ariaHidden = null;
    this.listen();
    void this.stayAwake();
  }

  /** Show what is to be seen now; `T_site_cam` is of the picture that is drawn. */
  turn(T_site_cam: Matrix4 | null, field_rad: number, now_ms: number): void {
    this.offer();
    this.take(this.button.held(now_ms), now_ms);
    if (this.at !== null && now_ms - this.touched_ms > MENU_STAYS_MS) this.at = null;
    const looked = T_site_cam && this.at === null ? this.look(T_site_cam, now_ms) : null;
    const heading_rad = T_site_cam ? headingOf(T_site_cam) : 0;
    const places = this.gaze.places(heading_rad);
    const words = this.at !== null || places ? this.deeds.map((deed) => deed.words()) : [];
    const told = this.sayings
      .filter((one) => !one.hidden && one.textContent !== "")
      .map((one) => one.textContent ?? "");
    const says = now_ms - this.said_ms < SAID_FOR_MS ? this.said : (told[0] ?? "");
    const done = this.at === null ? (looked?.progress ?? 0) : this.button.progress(now_ms);
    const shares = places?.map(
      (place) => 0.5 + Math.tan(Math.max(-1.2, Math.min(1.2, place))) / (2 * Math.tan(field_rad / 2)),
    );
    for (const eye of this.eyes)
      eye.show({
        says,
        words,
        at: this.at ?? looked?.at ?? null,
        done,
        shares: shares ?? null,
        isGazing: (looked?.progress ?? 0) > 0 || places !== null,
      });
  }

  /** Take what can be done now. */
  private offer(): void {
    const deeds = this.offered();
    if (deeds.length !== this.deeds.length) [this.gaze, this.at] = [new Gaze(deeds.length), null];
    this.deeds = deeds;
  }

  private look(T_site_cam: Matrix4, now_ms: number): { at: number | null; progress: number } {
    const pitch_rad = Math.asin(Math.max(-1, Math.min(1, column(T_site_cam, 2)[2])));
    const looked = this.gaze.take(pitch_rad, headingOf(T_site_cam), now_ms);
    if (typeof looked.event === "object" && looked.event !== null) this.do(looked.event.chosen, now_ms);
    return looked;
  }

  private take(press: Press | null, now_ms: number): void {
    if (press === null) return;
    this.touched_ms = now_ms;
    this.gaze.close();
    if (this.at === null) this.at = 0;
    else if (press === "next") this.at = (this.at + 1) % this.deeds.length;
    else this.do(this.at, now_ms);
  }

  private do(index: number, now_ms: number): void {
    this.at = null;
    const said = this.deeds[index]?.do();
    this.said = typeof said === "string" ? said : "";
    this.said_ms = now_ms;
  }

  /** Any key, any button and any touch is the one button. */
  private listen(): void {
    const down = (): void => {
      this.button.down(performance.now());
      void this.fill();
      void this.stayAwake();
    };
    const up = (): void => this.take(this.button.up(performance.now()), performance.now());
    window.addEventListener(
      "keydown",
      (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || NOT_OURS.has(event.key)) return;
        event.preventDefault();
        event.stopImmediatePropagation();
        if (!event.repeat) down();
      },
      { capture: true },
    );
    window.addEventListener("keyup", ({ key }) => {
      if (!NOT_OURS.has(key)) up();
    });
    window.addEventListener("pointerdown", down);
    window.addEventListener("pointerup", up);
    window.addEventListener("contextmenu", (event) => event.preventDefault());
    document.addEventListener("visibilitychange", () => void this.stayAwake());
  }

  /** Only after a press: browsers refuse it before. */
  private async fill(): Promise<void> {
    if (document.fullscreenElement) return;
    try {
      await document.documentElement.requestFullscreen({ navigationUI: "hide" });
    } catch {
      // the picture is as good in a window
    }
  }

  /** Keep the display on; the lock ends whenever the page is hidden. */
  private async stayAwake(): Promise<void> {
    if (this.isAwake || document.visibilityState !== "visible" || !("wakeLock" in navigator)) return;
    try {
      const lock = await navigator.wakeLock.request("screen");
      this.isAwake = true;
      lock.onrelease = () => {
        this.isAwake = false;
      };
    } catch {
      // on a low battery, or without https: then the display goes dark as it would anyway
    }
  }
}

interface Shown {
  readonly says: string;
  readonly words: readonly string[];
  readonly at: number | null;
  readonly done: number;
  /** Where each thing hangs across the picture, 0 to 1; null for a row. */
  readonly shares: readonly number[] | null;
  readonly isGazing: boolean;
}

/** What one eye sees over the picture. */
class Eye {
  private readonly root = document.createElement("div");
  private readonly says = document.createElement("p");
  private readonly menu = document.createElement("ol");
  private readonly reticle = document.createElement("div");

  constructor(place: HTMLElement) {
    this.root.className = "eye";
    this.says.className = "says";
    this.says.setAttribute("role", "status");
    this.reticle.className = "reticle";
    this.root.append(this.says, this.menu, this.reticle);
    place.append(this.root);
  }

  show({ says, words, at, done, shares, isGazing }: Shown): void {
    if (this.says.textContent !== says) this.says.textContent = says;
    this.reticle.hidden = !isGazing;
    this.reticle.style.setProperty("--done", `${Math.round(100 * done)}%`);
    this.root.classList.toggle("world", shares !== null);
    while (this.menu.childElementCount > words.length) this.menu.lastElementChild?.remove();
    while (this.menu.childElementCount < words.length) this.menu.append(document.createElement("li"));
    for (const [i, row] of ([...this.menu.children] as HTMLElement[]).entries()) {
      const text = words[i] ?? "";
      if (row.textContent !== text) row.textContent = text;
      row.setAttribute("aria-current", String(i === at));
      row.style.setProperty("--done", i === at ? `${Math.round(100 * done)}%` : "0%");
      row.style.setProperty("--at", `${(100 * (shares?.[i] ?? 0.5)).toFixed(1)}%`);
    }
  }
}
