/** The playback bar: shows where a replay stands, and asks for changes. */

import { element } from "./dom";
import { clockText, estimatorChoices, type Request, requestOfKey, SPEEDS } from "./playback";
import type { Session } from "./protocol";

export class Bar {
  private readonly form = element("bar", HTMLFormElement);
  private readonly play = element("play", HTMLButtonElement);
  private readonly seek = element("seek", HTMLInputElement);
  private readonly clock = element("clock", HTMLOutputElement);
  private readonly length = element("length", HTMLOutputElement);
  private readonly speed = element("speed", HTMLSelectElement);
  private readonly estimator = element("estimator", HTMLSelectElement);
  private session: Session | null = null;
  private dragging = false;
  private readonly ask: (request: Request) => void;

  constructor(ask: (request: Request) => void) {
    this.ask = ask;
    this.speed.append(...SPEEDS.map((value) => new Option(`${value}×`, String(value))));
    this.play.onclick = () => this.request({ action: this.playing ? "pause" : "play", value: null });
    this.seek.oninput = () => {
      this.dragging = true;
      this.clock.textContent = clockText(Number(this.seek.value));
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
    this.play.setAttribute("aria-label", session.playback.playing ? "Pause" : "Play");
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
    this.clock.textContent = clockText(position_s);
    if (this.session?.playback) this.session = { ...this.session, playback: { ...this.session.playback, position_s } };
  }

  private get playing(): boolean {
    return this.session?.playback?.playing ?? false;
  }

  private showEstimators(session: Session): void {
    const choices = estimatorChoices(session);
    const options = choices.map(({ name, reason }) => {
      const option = new Option(name, name, false, name === session.estimator);
      option.disabled = reason !== null;
      option.title = reason ?? "";
      return option;
    });
    this.estimator.replaceChildren(...options);
    this.estimator.title = choices.flatMap(({ name, reason }) => (reason ? [`${name}: ${reason}`] : [])).join("\n");
  }

  private key(event: KeyboardEvent): void {
    const { target } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || !this.session?.playback) return;
    if (
      target instanceof HTMLSelectElement ||
      target instanceof HTMLButtonElement ||
      target instanceof HTMLInputElement
    )
      return;
    const request = requestOfKey(event.key, event.shiftKey, this.session.playback, this.session.duration_s);
    if (request === null) return;
    event.preventDefault();
    this.request(request);
  }

  private request(request: Request): void {
    this.ask(request);
  }
}
