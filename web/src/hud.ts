/** The figures in the corner, and the one sentence in the middle. */

import { element, tell } from "./dom";
import { headingOf } from "./frames";
import { FrameRate, PoseAge } from "./playback";
import type { CameraPose, FrameMessage } from "./wire";
import {
  compassPoint,
  degreesText,
  headingSigma,
  horizontalSigma,
  metresText,
  motionColour,
  motionWords,
  type Situation,
  sentenceFor,
} from "./words";

/** Ground truth as good as this is shown as the truth. */
const EXACT_M = 0.005;
const EXACT_RAD = 0.001;

export class Hud {
  readonly rate = new FrameRate();
  readonly age = new PoseAge();
  private readonly cells = Object.fromEntries(
    ["rate", "age", "position", "heading", "motion", "estimator-now"].map((id) => [id, element(id, HTMLElement)]),
  );
  private readonly notice = element("notice", HTMLElement);
  private readonly toast = element("toast", HTMLElement);
  private toastTimer: number | undefined;

  /** Show the figures of the picture that is drawn now. */
  show(frame: FrameMessage | null, playing: boolean, now_ms: number): void {
    this.set("rate", playing ? `${this.rate.at(now_ms).toFixed(0)} per second` : "paused");
    const age_ms = this.age.at(now_ms);
    this.set("age", age_ms === null || !playing ? "–" : `${Math.round(age_ms)} ms`);
    const pose = frame?.pose ?? null;
    this.set("position", pose ? positionText(pose) : "–");
    this.set("heading", pose ? headingText(pose) : "–");
    const model = pose?.motionModel ?? null;
    this.set("motion", pose && model ? `${model}: ${motionWords(model, pose.estimator)}` : "none");
    this.cells["motion"]?.style.setProperty("--motion", motionColour(model));
    this.set("estimator-now", pose ? pose.estimator : "–");
  }

  /** Say what stands in the way, or nothing. */
  say(situation: Situation): void {
    tell(this.notice, sentenceFor(situation));
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

function positionText({ covariance, isTruth }: CameraPose): string {
  const sigma_m = horizontalSigma(covariance);
  return isTruth && sigma_m < EXACT_M ? "true" : `± ${metresText(sigma_m)}`;
}

function headingText({ T_site_cam, covariance, headingKnown, isTruth }: CameraPose): string {
  if (!headingKnown) return "unknown";
  const point = compassPoint(headingOf(T_site_cam));
  const sigma_rad = headingSigma(covariance);
  return isTruth && sigma_rad < EXACT_RAD ? `${point}, true` : `${point} ± ${degreesText(sigma_rad)}`;
}
