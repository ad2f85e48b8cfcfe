/** The start page put together: the square, the ways through it, and the tools beside it. DOM and the stage. */

import { Beside } from "../beside/beside";
import { Card } from "../card";
import { element, tell } from "../dom";
import type { Vector3 } from "../frames";
import { say } from "../language/speech";
import { fillLegend } from "../legend";
import { Narrator } from "../narrator";
import { contains, type Place } from "../plan";
import type { Monument, Site, View } from "../site";
import { loadGround } from "../walkable";
import { hashOf, readAddress, type Shown } from "./address";
import type { Directory } from "./directory";
import { Epochs } from "./epochs";
import { type Eye, looking } from "./eye";
import { overlooking } from "./finding";
import { type Epoch, firstOf } from "./first";
import type { Ground } from "./ground";
import { Guide } from "./guide";
import { fillKeys } from "./keys";
import { save, signed } from "./photograph";
import { Places } from "./places";
import { Pointer } from "./pointer";
import { Sheets } from "./sheets";
import { Stage } from "./stage";
import { Tape } from "./tape";
import { isTaken } from "./typing";
import type { Way } from "./way";

/** From over the south-eastern corner, along the square. */
const FROM: Vector3 = [78, -112, 66];
const TO: Vector3 = [-25, 0, 2];
const TOAST_MS = 6000;
/** Of the way to the first picture; what is left when both have come is to make it ready. */
const SCRIPT_SHARE = 0.2;
const MODEL_SHARE = 0.6;

export class Browse {
  readonly stage: Stage;
  private readonly epochs: Epochs;
  private readonly card: Card;
  private readonly tape: Tape;
  private readonly guide: Guide;
  private readonly places: Places;
  private readonly sheets: Sheets;
  /** Those who walk now; null where the address wants the square alone. */
  readonly beside: Beside | null;
  private readonly grounds = new Map<string, Ground>();
  /** Those that know of their columns. */
  private readonly posted = new WeakSet<Ground>();
  /** The stop that is stood at, and the eye that stands there: a finer ground may be a little higher. */
  private stood: { readonly stop: View; eye: Eye } | null = null;
  private toast: number | null = null;

  constructor(
    readonly site: Site,
    shown: Shown,
    directory: Directory,
  ) {
    this.stage = new Stage(element("view", HTMLCanvasElement), element("stick", HTMLElement), site.eye_height_m);
    const { explorer } = this.stage;
    const calm = matchMedia("(prefers-reduced-motion: reduce)");
    this.epochs = new Epochs(site, this.stage, firstOf(site, shown), () => calm.matches);
    this.card = new Card(
      site,
      () => this.epochs.square,
      (monument, variant) => this.epochs.choose(monument, variant),
    );
    this.tape = new Tape(this.stage, (text) => this.say(text));
    this.places = new Places(
      site,
      (monument) => this.visit(monument),
      (place) => this.pick(place),
    );
    this.guide = new Guide(
      site.views.filter(({ text }) => text !== null),
      (stop) => this.stand(stop, false),
      () => !explorer.isFlying,
      () => this.showWay(),
    );
    this.sheets = new Sheets((id) => {
      if (id === "places") this.places.open();
      this.card.show(null, null);
    });
    new Pointer(this.stage, site, this.tape, (monument, part) => {
      this.sheets.close();
      this.card.show(monument, part);
    });
    explorer.changed = () => this.showWay();
    this.epochs.changed = () => this.showEpoch();
    this.epochs.come = (share) => {
      element("arrival-bar", HTMLProgressElement).value = SCRIPT_SHARE + share * MODEL_SHARE;
    };
    this.epochs.come(0);
    this.stage.refined = () => this.standAgain();
    this.stage.eachPicture(() => {
      this.places.show(this.stage.eye);
      return false;
    });
    const isAlone = new URLSearchParams(location.search).get("walkers") === "0";
    this.beside = isAlone ? null : new Beside(this.stage, site.eye_height_m, directory);
    new Narrator(() => this.stage.standpoint).learn(site.monuments);
    fillLegend(element("legend", HTMLElement), site);
    fillKeys(element("keys", HTMLElement));
    this.listen();
    this.showWay();
  }

  /** Load what is asked for; resolves at its first picture. */
  async start(shown: Shown): Promise<void> {
    for (const [monument, variant] of shown.variants) this.epochs.choose(monument, variant);
    this.tint(shown.isTinted);
    if (shown.hour !== null) this.light(shown.hour);
    this.look(shown);
    await this.epochs.set(shown.past ?? (firstOf(this.site, shown) === "today" ? 0 : 1));
    this.look(shown);
    await this.stage.drawn();
    document.body.classList.remove("empty");
    void this.learnGround();
  }

  /** Show what another address asks for. */
  async take(shown: Shown): Promise<void> {
    for (const [monument, variant] of shown.variants) this.epochs.choose(monument, variant);
    this.tint(shown.isTinted);
    if (shown.hour !== null) this.light(shown.hour);
    if (shown.past !== null) await this.epochs.set(shown.past);
    this.look(shown);
  }

  get stats(): Readonly<Record<string, unknown>> {
    const { stage, epochs } = this;
    const isWhole = epochs.isWhole && stage.isSettled;
    return { ...stage.stats, ...this.beside?.stats, model: epochs.epoch, way: stage.explorer.way, whole: isWhole };
  }

  /** What is shown now, as an address tells it. */
  get shown(): Shown {
    const { stage, epochs } = this;
    return {
      eye: stage.eye,
      way: stage.explorer.way,
      about_m: stage.explorer.about_m,
      past: epochs.share,
      hour: epochs.solarHour,
      isTinted: epochs.isTinted,
      variants: epochs.chosen,
      stop: null,
    };
  }

  private listen(): void {
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-way]"))
      button.onclick = () => this.move(button.dataset["way"] as Way);
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-epoch]")) {
      const epoch = button.dataset["epoch"] as Epoch;
      button.onclick = () => void this.epochs.turnTo(epoch).catch((error: unknown) => this.complain(error));
    }
    element("epochs", HTMLElement).hidden = this.epochs.there.length < 2;
    const past = element("past", HTMLInputElement);
    past.oninput = () => void this.epochs.set(Number(past.value) / 100).catch((error: unknown) => this.complain(error));
    const hour = element("hour", HTMLInputElement);
    hour.oninput = () => this.light(Number(hour.value));
    this.tellHour();
    element("evidence", HTMLButtonElement).onclick = () => this.tint(!this.epochs.isTinted);
    element("tape", HTMLButtonElement).onclick = () => this.tape.toggle();
    element("share-link", HTMLButtonElement).onclick = () => void this.share();
    element("photograph", HTMLButtonElement).onclick = () => void this.photograph();
    window.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("hashchange", () => {
      void this.take(readAddress("", location.hash)).catch((error: unknown) => this.complain(error));
    });
  }

  private key(event: KeyboardEvent): void {
    const { key, code, target } = event;
    if (key === "Escape") {
      if (this.sheets.close()) return;
      if (this.tape.isOn) this.tape.toggle();
      else this.card.show(null, null);
    }
    if (isTaken(event)) return;
    if (key === "1") this.move("orbit");
    else if (key === "2") this.move("walk");
    else if (key === "3") this.move("fly");
    else if (code === "KeyT")
      element("epochs", HTMLElement).querySelector<HTMLElement>("[aria-pressed=false]")?.click();
    else if (code === "KeyM") this.tape.toggle();
    else if (code === "KeyN" && this.guide.isOn) this.guide.move(1);
    else if (code === "Space" && this.guide.isOn && target === this.stage.canvas) this.guide.toggle();
  }

  private move(way: Way): void {
    if (this.guide.isOn) this.guide.end();
    this.stage.explorer.take(way);
  }

  private look({ stop, eye, way, about_m }: Shown): void {
    const view = this.site.views.find(({ id }) => id === stop);
    const { explorer } = this.stage;
    this.stood = null;
    if (eye) explorer.go(eye, way ?? "fly", about_m ?? undefined, true);
    else if (view) this.stand(view, true);
    else explorer.go(looking(FROM, TO), "orbit", Math.hypot(FROM[0] - TO[0], FROM[1] - TO[1], FROM[2] - TO[2]), true);
  }

  private stand(stop: View, isCut: boolean): void {
    const eye = this.eyeAt(stop);
    this.stood = { stop, eye };
    this.stage.explorer.go(eye, this.stage.explorer.ground ? "walk" : "fly", undefined, isCut);
  }

  private standAgain(): void {
    const { stood } = this;
    const { explorer } = this.stage;
    if (!stood || explorer.isFlying) return;
    const [e, n, u] = stood.eye.place_site_m;
    const [e1, n1, u1] = this.stage.eye.place_site_m;
    if (Math.hypot(e - e1, n - n1, u - u1) > 0.01) this.stood = null;
    else this.stand(stood.stop, true);
  }

  private eyeAt({ e_m, n_m, heading_rad, pitch_rad }: View): Eye {
    const ground_m = this.stage.groundAt(e_m, n_m) ?? 0;
    return { place_site_m: [e_m, n_m, ground_m + this.site.eye_height_m], heading_rad, pitch_rad };
  }

  private visit(monument: Monument): void {
    this.sheets.close();
    if (this.guide.isOn) this.guide.end();
    const { eye, about_m } = overlooking(monument.footprint, this.places.middle);
    this.stage.explorer.go(eye, "orbit", about_m);
    this.card.show(monument, null);
  }

  /** Walk where one can, on the plan, else look at what stands there. */
  private pick(place: Place): void {
    const { explorer } = this.stage;
    if (explorer.ground?.heightAt(place, -100, 100) != null) {
      const eye = explorer.standAt(place[0], place[1], this.stage.eye.heading_rad);
      if (eye) explorer.go(eye, "walk");
      return;
    }
    const smallestFirst = [...this.site.monuments].sort((a, b) => a.footprint.length - b.footprint.length);
    const there = smallestFirst.find(({ id, footprint }) => id !== "square" && contains(footprint, place));
    if (there) this.visit(there);
  }

  private tint(on: boolean): void {
    this.epochs.tint(on);
    element("evidence", HTMLButtonElement).setAttribute("aria-pressed", String(on));
    element("legend", HTMLElement).hidden = !on;
  }

  private light(hour: number): void {
    element("hour", HTMLInputElement).value = String(hour);
    this.epochs.light(hour);
    this.tellHour();
  }

  private tellHour(): void {
    const slider = element("hour", HTMLInputElement);
    const minutes = Math.round(Number(slider.value) * 60);
    const text = `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}`;
    element("hour-words", HTMLElement).textContent = text;
    slider.ariaValueText = text;
  }

  private showWay(): void {
    const { way, ground } = this.stage.explorer;
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-way]")) {
      button.setAttribute("aria-pressed", String(button.dataset["way"] === way && !this.guide.isOn));
      if (button.dataset["way"] === "walk") button.disabled = ground === null;
    }
    const hasStick = way !== "orbit" && matchMedia("(pointer: coarse)").matches;
    element("stick", HTMLElement).hidden = !hasStick;
    document.body.classList.toggle("with-stick", hasStick);
  }

  private showEpoch(): void {
    const { share, epoch } = this.epochs;
    element("past", HTMLInputElement).value = String(Math.round(100 * share));
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-epoch]"))
      button.setAttribute("aria-pressed", String(button.dataset["epoch"] === epoch));
    const ground = this.grounds.get(epoch) ?? null;
    const { square } = this.epochs;
    if (ground && square && !this.posted.has(ground)) {
      ground.put(square.posts);
      this.posted.add(ground);
    }
    if (ground !== this.stage.explorer.ground) {
      this.stage.explorer.ground = ground;
      this.showWay();
    }
  }

  private async learnGround(): Promise<void> {
    const { walkable } = this.site;
    if (walkable === null) return;
    try {
      for (const epoch of this.epochs.there) this.grounds.set(epoch, await loadGround(walkable, epoch));
      this.showEpoch();
      this.standAgain(); // from now on one walks from there
    } catch (error) {
      console.warn("nobody can walk: the ground did not come", error);
    }
  }

  private async share(): Promise<void> {
    const url = new URL(location.href);
    [url.search, url.hash] = ["", hashOf(this.shown)];
    history.replaceState(null, "", url);
    try {
      await navigator.clipboard.writeText(url.href);
      this.say(say("link.copied"));
    } catch {
      this.say(say("link.in_address")); // no clipboard without TLS
    }
  }

  private async photograph(): Promise<void> {
    try {
      const picture = this.stage.picture();
      signed(picture, `${this.site.name} · ${this.site.attribution}`);
      await save(picture, `agora-${this.epochs.epoch}.png`);
      this.say(say("photograph.saved"));
    } catch (error) {
      this.complain(error);
    }
  }

  private say(text: string | null): void {
    const toast = element("toast", HTMLElement);
    tell(toast, text);
    if (this.toast !== null) window.clearTimeout(this.toast);
    this.toast = text === null || this.tape.isOn ? null : window.setTimeout(() => tell(toast, null), TOAST_MS);
  }

  private complain(error: unknown): void {
    this.say(say("trouble.model"));
    console.warn(error);
    this.showEpoch();
  }
}
