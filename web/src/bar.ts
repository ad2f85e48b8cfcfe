/** The playback bar: shows where a replay stands, and asks for changes. */

import { element } from "./dom";
import { say } from "./language/speech";
import { clockText, estimatorChoices, type Request, requestOfKey, SPEEDS } from "./playback";
import type { Session } from "./protocol";

export class Bar {
  private readonly form = element("bar", HTMLFormElement);
  private readonly play = element("play", HTMLButtonElement);
  private readonly seek = element("seek", HTMLInputElement);
  private readonly clock = element("clock", HTMLElement);
  private readonly length = element("length", HTMLElement);
  private readonly speed = element("speed", HTMLSelectElement);
  private readonly estimator = element("estimator", HTMLSelectElement);
  private session: Session | null = null;
  private dragging = false;
  private listed = "";
  private readonly ask: (request: Request) => void;

  constructor(ask: (request: Request) => void) {
    this.ask = ask;
    this.speed.append(...SPEEDS.map((value) => new Option(`${value}×`, String(value))));
    this.play.onclick = () => this.request({ action: this.playing ? "pause" : "play", value: null });
    this.seek.oninput = () => {
      this.dragging = true;
      this.showClock(Number(this.seek.value));
    };
    this.seek.onchange = () => {
      this.dragging = false;
      this.request({ action: "seek", value: Number(this.seek.value) });
    };
    this.speed.onchange = () => this.request({ action: "speed", value: Number(this.speed.value) });
    this.estimator.onchange = () => this.request({ action: "estimator", value: this.estimator.value });
    this.form.onsubmit = () => false;
    window.addEventListener("keydown", (event) => this.key(event));
  }

  /** Show a session's state. */
  show(session: Session): void {
    this.session = session;
    this.form.hidden = session.playback === null;
    if (session.playback === null) return;
    this.play.dataset["playing"] = String(session.playback.playing);
    const verb = say(session.playback.playing ? "bar.pause" : "bar.play");
    this.play.setAttribute("aria-label", verb);
    this.play.title = say("bar.key", { verb });
    this.seek.max = String(session.duration_s);
    this.length.textContent = clockText(session.duration_s);
    const { speed } = session.playback;
    if (![...this.speed.options].some((option) => option.value === String(speed)))
      this.speed.append(new Option(`${speed}×`, String(speed)));
    this.speed.value = String(speed);
    this.showEstimators(session);
    this.at(session.playback.position_s);
  }

  /** Show where in the walk the picture is. */
  at(position_s: number): void {
    if (this.dragging) return;
    this.seek.value = String(position_s);
    this.showClock(position_s);
    if (this.session?.playback) this.session = { ...this.session, playback: { ...this.session.playback, position_s } };
  }

  private showClock(position_s: number): void {
    const text = clockText(position_s);
    if (this.clock.textContent === text) return;
    this.clock.textContent = text;
    this.seek.setAttribute("aria-valuetext", say("bar.place", { now: text, length: this.length.textContent ?? "" }));
  }

  private get playing(): boolean {
    return this.session?.playback?.playing ?? false;
  }

  private showEstimators(session: Session): void {
    const choices = estimatorChoices(session);
    const listed = JSON.stringify(choices);
    // options that are replaced would close a list that is open
    if (listed !== this.listed) {
      const options = choices.map(({ name, reason }) => {
        const option = new Option(reason === null ? name : say("bar.unavailable", { name, reason }), name);
        option.disabled = reason !== null;
        return option;
      });
      this.estimator.replaceChildren(...options);
    }
    this.listed = listed;
    this.estimator.value = session.estimator;
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.session?.playback) return;
    if (isTheirs(event, this.seek)) return;
    const request = requestOfKey(event.key, event.shiftKey, this.session.playback, this.session.duration_s);
    if (request === null) return;
    event.preventDefault();
    this.request(request);
  }

  private request(request: Request): void {
    this.ask(request);
  }
}

/** Whether the focused element has a use of its own for the key. */
function isTheirs({ key, target }: KeyboardEvent, seek: HTMLInputElement): boolean {
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement) return key === " ";
  return target instanceof HTMLInputElement && target !== seek && key !== " ";
}
