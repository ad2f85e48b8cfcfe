/** The replay's controls: play, step, speed, loop, estimator, clock. DOM only. */

import { element } from "../dom";
import { say } from "../language/speech";
import { clockText, estimatorChoices, SPEEDS } from "../playback";
import type { Session } from "../protocol";
import type { Deed } from "./keys";
import { estimatorLine } from "./told";

export class Transport {
  private readonly play = element("play", HTMLButtonElement);
  private readonly loop = element("loop", HTMLButtonElement);
  private readonly clock = element("clock", HTMLElement);
  private readonly length = element("length", HTMLElement);
  private readonly speed = element("speed", HTMLSelectElement);
  private readonly estimator = element("estimator", HTMLSelectElement);
  private listed = "";
  private isPlaying = false;
  private isLooping = false;

  /** `act` does what is asked for. */
  constructor(act: (deed: Deed) => void) {
    this.speed.append(...SPEEDS.map(speedOption));
    this.play.onclick = () => act({ action: this.isPlaying ? "pause" : "play", value: null });
    this.loop.onclick = () => act({ action: "loop", value: !this.isLooping });
    this.speed.onchange = () => act({ action: "speed", value: Number(this.speed.value) });
    this.estimator.onchange = () => act({ action: "estimator", value: this.estimator.value });
    element("step-back", HTMLButtonElement).onclick = () => act({ action: "step", direction: -1 });
    element("step-on", HTMLButtonElement).onclick = () => act({ action: "step", direction: 1 });
    element("help-open", HTMLButtonElement).onclick = () => act({ action: "help" });
  }

  /** Show how the replay stands. */
  show(session: Session): void {
    const { playback } = session;
    if (playback === null) return;
    [this.isPlaying, this.isLooping] = [playback.playing, playback.looping];
    const verb = playback.playing ? say("bar.pause") : say("bar.play");
    this.play.dataset["playing"] = String(playback.playing);
    this.play.setAttribute("aria-label", verb);
    this.play.title = say("bar.key", { verb });
    this.loop.setAttribute("aria-pressed", String(playback.looping));
    this.length.textContent = clockText(session.duration_s);
    if (![...this.speed.options].some(({ value }) => value === String(playback.speed)))
      this.speed.append(speedOption(playback.speed));
    this.speed.value = String(playback.speed);
    this.listEstimators(session);
  }

  /** Show where in the walk the picture is. */
  at(position_s: number): void {
    const text = clockText(position_s);
    if (this.clock.textContent !== text) this.clock.textContent = text;
  }

  private listEstimators(session: Session): void {
    const choices = estimatorChoices(session);
    const listed = JSON.stringify(choices);
    // options that are replaced would close a list that is open
    if (listed !== this.listed) {
      const options = choices.map(({ name, reason }) => {
        const line = estimatorLine(name);
        const option = new Option(reason === null ? line : say("bar.unavailable", { name: line, reason }), name);
        option.disabled = reason !== null;
        return option;
      });
      this.estimator.replaceChildren(...options);
    }
    this.listed = listed;
    this.estimator.value = session.estimator;
    this.estimator.disabled = choices.length < 2;
  }
}

function speedOption(value: number): HTMLOptionElement {
  return new Option(`${value}×`, String(value));
}
