/** The guided tour on the page: its text, its buttons, and the flights from stop to stop. DOM only. */

import { element, tell } from "../dom";
import { say, sayNumber } from "../language/speech";
import type { View } from "../site";
import { after, begun, type Journey, moved, stayOf, toggled } from "./journey";

/** A longer time between two looks is a page that was not seen. */
const LONGEST_STEP_MS = 500;
const LOOK_EVERY_MS = 100;

export class Guide {
  private journey: Journey | null = null;
  private timer: number | null = null;
  private last_ms = 0;
  private readonly panel = element("tour", HTMLElement);
  private readonly play = element("tour-play", HTMLButtonElement);

  /** `goTo` flies to a stop; the time at a stop counts while `isThere`. */
  constructor(
    private readonly stops: readonly View[],
    private readonly goTo: (stop: View) => void,
    private readonly isThere: () => boolean,
    private readonly changed: () => void,
  ) {
    const open = element("tour-open", HTMLButtonElement);
    open.hidden = stops.length === 0;
    open.onclick = () => (this.journey ? this.end() : this.begin());
    element("tour-previous", HTMLButtonElement).onclick = () => this.move(-1);
    element("tour-next", HTMLButtonElement).onclick = () => this.move(1);
    element("tour-end", HTMLButtonElement).onclick = () => this.end();
    this.play.onclick = () => this.toggle();
    // on a small screen it scrolls, by keys too
    element("tour-text", HTMLElement).tabIndex = 0;
    this.show();
  }

  get isOn(): boolean {
    return this.journey !== null;
  }

  begin(): void {
    this.take(begun(), true);
  }

  end(): void {
    this.take(null, false);
  }

  toggle(): void {
    const { journey } = this;
    if (!journey) return;
    const next = toggled(journey, this.stops.length, this.stay_ms(journey));
    this.take(next, next.index !== journey.index);
  }

  move(by: number): void {
    const { journey } = this;
    if (!journey) return;
    const next = moved(journey, by, this.stops.length);
    this.take(next, next.index !== journey.index);
  }

  private take(journey: Journey | null, flies: boolean): void {
    const began = (this.journey === null) !== (journey === null);
    this.journey = journey;
    const stop = journey ? this.stops[journey.index] : undefined;
    if (flies && stop) this.goTo(stop);
    if (this.timer !== null) window.clearInterval(this.timer);
    this.last_ms = performance.now();
    this.timer = journey?.plays ? window.setInterval(() => this.tick(), LOOK_EVERY_MS) : null;
    this.show();
    if (began) this.changed();
  }

  private tick(): void {
    const now_ms = performance.now();
    const passed_ms = Math.min(LONGEST_STEP_MS, now_ms - this.last_ms);
    this.last_ms = now_ms;
    const { journey } = this;
    if (!journey || !this.isThere()) return;
    const next = after(journey, passed_ms, this.stay_ms(journey), this.stops.length);
    if (next.index !== journey.index || next.plays !== journey.plays) this.take(next, next.index !== journey.index);
    else {
      this.journey = next;
      this.showProgress();
    }
  }

  private stay_ms({ index }: Journey): number {
    return stayOf(this.stops[index]?.text ?? null);
  }

  private show(): void {
    const { journey, panel, play } = this;
    panel.hidden = journey === null;
    element("tour-open", HTMLButtonElement).setAttribute("aria-pressed", String(journey !== null));
    document.body.classList.toggle("touring", journey !== null);
    if (!journey) return;
    const stop = this.stops[journey.index];
    const count = this.stops.length;
    tell(
      element("tour-number", HTMLElement),
      say("tour.number", { number: sayNumber(journey.index + 1), count: sayNumber(count) }),
    );
    tell(element("tour-name", HTMLElement), stop?.name ?? null);
    tell(element("tour-text", HTMLElement), stop?.text ?? null);
    element("tour-previous", HTMLButtonElement).disabled = journey.index === 0;
    element("tour-next", HTMLButtonElement).disabled = journey.index === count - 1;
    const words = say(journey.plays ? "tour.pause" : "tour.play");
    play.setAttribute("aria-label", words);
    play.title = words;
    play.querySelector("use")?.setAttribute("href", journey.plays ? "#i-pause" : "#i-play");
    this.showProgress();
  }

  private showProgress(): void {
    const { journey } = this;
    if (journey) element("tour-progress", HTMLProgressElement).value = journey.stood_ms / this.stay_ms(journey);
  }
}
