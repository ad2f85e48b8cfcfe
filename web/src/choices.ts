/** What a visitor chooses of the model on the AR page: how much of it, whose sun, the evidence's colours, rival reconstructions. DOM only. */

import { element, tell } from "./dom";
import { type Key, say } from "./language/speech";
import { fillLegend } from "./legend";
import type { Look, SunWish } from "./look";
import type { Square } from "./model";
import type { Monument, Site } from "./site";
import type { Sun } from "./sun";
import { compassPoint } from "./words";

const STEP = 10;
/** Wishes of the sun, in the order of one button. */
const SUN_WISHES = [
  ["now", "sun.now"],
  ["ancient", "sun.ancient"],
  [7.5, "sun.morning"],
  [12, "sun.noon"],
  [17.5, "sun.evening"],
] as const satisfies readonly (readonly [SunWish, Key])[];

export class Choices {
  private readonly past = element("past", HTMLInputElement);
  private readonly sun = element("sun", HTMLSelectElement);
  private readonly evidence = element("evidence", HTMLInputElement);
  private readonly said = element("said", HTMLElement);
  private told = false;
  private square: Square | null = null;
  /** What `t` comes back to. */
  private before = 85;

  constructor(
    private readonly look: Look,
    private readonly setPast: (share: number) => void,
    private readonly redraw: () => void,
  ) {
    this.past.oninput = () => this.apply();
    this.apply();
    this.sun.replaceChildren(
      ...SUN_WISHES.map(([wish, words]) => new Option(say(words), String(wish), false, wish === look.sunWish)),
    );
    this.sun.onchange = () => this.wishSun(SUN_WISHES[this.sun.selectedIndex]?.[0] ?? "now");
    this.evidence.onchange = () => this.tint();
    window.addEventListener("keydown", (event) => this.key(event));
  }

  /** Offer what a site and its model have. */
  show(site: Site, square: Square): void {
    this.square = square;
    fillLegend(element("legend", HTMLElement), site);
    this.tint();
    const rivals = element("rivals", HTMLElement);
    rivals.replaceChildren(...site.monuments.flatMap((monument) => rivalsOf(monument, square) ?? []));
    rivals.hidden = rivals.childElementCount === 0;
  }

  /** Say where the sun of the drawing stands. */
  tellSun(sun: Sun | null): void {
    const words = element("sun-words", HTMLElement);
    const height_deg = sun === null ? null : Math.round((sun.elevation_rad * 180) / Math.PI);
    if (sun === null || height_deg === null) tell(words, null);
    else if (height_deg < 0) tell(words, say("sun.down"));
    else
      tell(
        words,
        say("sun.stands", {
          point: compassPoint(sun.azimuth_rad),
          angle: say("number.degrees", { value: height_deg }),
        }),
      );
  }

  /** Whether anything of the past is shown. */
  get isPast(): boolean {
    return Number(this.past.value) > 0;
  }

  /** Show the past, or today. */
  toggle(): void {
    const now = Number(this.past.value);
    if (now > 0) this.before = now;
    this.past.value = String(now > 0 ? 0 : this.before);
    this.apply();
  }

  /** Take the next wish of the sun; returns it in words. */
  nextSun(): string {
    const index = SUN_WISHES.findIndex(([wish]) => wish === this.look.sunWish);
    const [wish, words] = SUN_WISHES[(index + 1) % SUN_WISHES.length] ?? SUN_WISHES[0];
    this.wishSun(wish);
    return say(words);
  }

  /** Colour by evidence, or no longer; returns what is shown, in words. */
  toggleEvidence(): string {
    this.evidence.checked = !this.evidence.checked;
    this.tint();
    return say(this.evidence.checked ? "evidence.colours" : "evidence.own_colours");
  }

  private wishSun(wish: SunWish): void {
    this.look.sunWish = wish;
    this.sun.selectedIndex = SUN_WISHES.findIndex(([one]) => one === wish);
    this.tellSun(this.look.sun);
    this.redraw();
  }

  private tint(): void {
    element("legend", HTMLElement).hidden = !this.evidence.checked;
    this.square?.showEvidence(this.evidence.checked);
  }

  private apply(): void {
    const share = Number(this.past.value);
    this.past.ariaValueText = share === 0 ? say("past.none") : say("past.share", { percent: share });
    // a screen reader tells of the slider only while it has the focus
    if (this.told) this.said.textContent = document.activeElement === this.past ? "" : this.past.ariaValueText;
    this.told = true;
    this.setPast(share / 100);
  }

  /** T: past or today; [ and ]: less and more of the past. */
  private key({ key, ctrlKey, metaKey, altKey, target }: KeyboardEvent): void {
    if (ctrlKey || metaKey || altKey || target instanceof HTMLSelectElement) return;
    const by = key === "[" ? -STEP : key === "]" ? STEP : 0;
    if (key === "t") this.toggle();
    else if (by !== 0) {
      this.past.value = String(Number(this.past.value) + by);
      this.apply();
    }
  }
}

/** Return the rival reconstructions of a monument to choose from; null where it has none. */
function rivalsOf({ id, name, variants }: Monument, square: Square): HTMLElement | null {
  const now = square.variantOf(id);
  if (variants.length < 2 || now === null) return null;
  const row = document.createElement("p");
  const label = document.createElement("label");
  const menu = document.createElement("select");
  menu.append(...variants.map((variant) => new Option(variant.name, variant.id, false, variant.id === now)));
  menu.onchange = () => square.showVariant(id, menu.value);
  label.append(name, menu);
  row.append(label);
  return row;
}
