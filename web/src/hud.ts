/** What is known, in plain words, in the corner; its figures behind a key; and the one sentence in the middle. */

import { adviceOf, headingWords, placeWords, type Shown } from "./advice";
import { element, tell } from "./dom";
import { say } from "./language/speech";
import { FrameRate } from "./playback";
import type { FrameMessage } from "./wire";
import { motionColour, motionWords, type Situation, sentenceFor } from "./words";

export class Hud {
  readonly rate = new FrameRate();
  private readonly cells = Object.fromEntries(
    ["rate", "age", "position", "heading", "motion", "estimator-now"].map((id) => [id, element(id, HTMLElement)]),
  );
  private readonly advice = element("advice", HTMLElement);
  private readonly figures = element("figures", HTMLElement);
  private readonly more = element("more", HTMLButtonElement);
  private readonly notice = element("notice", HTMLElement);
  private readonly toast = element("toast", HTMLElement);
  private toastTimer: number | undefined;

  constructor() {
    this.more.onclick = () => this.turn();
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey, altKey, target }) => {
      if (key === "i" && !ctrlKey && !metaKey && !altKey && !(target instanceof HTMLSelectElement)) this.turn();
    });
  }

  /** Show the figures, or hide them again. */
  private turn(): void {
    this.figures.hidden = !this.figures.hidden;
    this.more.setAttribute("aria-expanded", String(!this.figures.hidden));
  }

  /** Say why the square is shown as it is, and what to do about it. */
  advise(shown: Shown): void {
    tell(this.advice, adviceOf(shown));
  }

  /** Show the figures of the picture that is drawn now. */
  show(frame: FrameMessage | null, age_ms: number | null, playing: boolean, now_ms: number): void {
    this.set("rate", playing ? say("hud.rate_of", { count: this.rate.at(now_ms) }) : say("hud.paused"));
    this.set("age", age_ms === null || !playing ? "–" : `${Math.round(age_ms)} ms`);
    const pose = frame?.pose ?? null;
    this.set("position", pose ? placeWords(pose) : say("hud.unknown_yet"));
    this.set("heading", pose ? headingWords(pose) : say("hud.unknown_yet"));
    const model = pose?.motionModel ?? null;
    this.set("motion", pose && model ? motionText(model, pose.estimator) : say("hud.none"));
    this.cells["motion"]?.style.setProperty("--motion", motionColour(model));
    this.set("estimator-now", pose ? pose.estimator : "–");
  }

  /** Say what stands in the way, or nothing. */
  say(situation: Situation): void {
    const sentence = sentenceFor(situation);
    tell(this.notice, sentence);
    // the news of a trouble is its own sentence: once is enough
    if (sentence !== null && this.toast.textContent === sentence) tell(this.toast, null);
  }

  /** Show an error, or news, for a few seconds. */
  announce(text: string): void {
    tell(this.toast, text);
    window.clearTimeout(this.toastTimer);
    this.toastTimer = window.setTimeout(() => tell(this.toast, null), 6000);
  }

  private set(id: string, text: string): void {
    const cell = this.cells[id];
    if (cell && cell.textContent !== text) cell.textContent = text;
  }
}

function motionText(model: string, estimator: string): string {
  return say("motion.with_name", { model, words: motionWords(model, estimator) });
}
