/** The view told in words: shown and spoken when asked for, and put before screen readers whenever somebody stands still. DOM only. */

import { describe, type Solid, type Standpoint } from "./describe";
import { descriptionWords } from "./description";
import { element, tell } from "./dom";
import { language, say } from "./language/speech";
import type { Monument } from "./site";

/** Who has moved and turned less than this for so long stands still. */
const STILL_MS = 1500;
const LOOK_EVERY_MS = 300;
const STILL_M = 0.5;
const STILL_RAD = 0.1;
/** A description that was asked for stays for so long, and then until somebody moves. */
const SHOWN_MS = 8000;
const KEY = "v";

export class Narrator {
  private solids: readonly Solid[] = [];
  private names: ReadonlyMap<string, string> = new Map();
  private readonly live = element("described", HTMLElement);
  private readonly panel = element("description", HTMLElement);
  private shown_ms = Number.NEGATIVE_INFINITY;
  private since: { readonly from: Standpoint; readonly t_ms: number } | null = null;

  /** `standpoint`: where the eye is now; null where nobody knows. */
  constructor(private readonly standpoint: () => Standpoint | null) {
    element("describe", HTMLButtonElement).onclick = () => this.speak();
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey, altKey, target }) => {
      const isTyped = target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
      if (key === KEY && !ctrlKey && !metaKey && !altKey && !isTyped) this.speak();
    });
    window.setInterval(() => this.turn(performance.now()), LOOK_EVERY_MS);
  }

  /** Take what stands on the site. */
  learn(monuments: readonly Monument[]): void {
    this.solids = monuments.filter(({ footprint }) => footprint.length > 2);
    this.names = new Map(monuments.map(({ id, name }) => [id, name]));
  }

  /** Return the present view in words. */
  words(): string {
    const from = this.standpoint();
    if (from === null || this.solids.length === 0) return say("sight.unknown");
    return descriptionWords(describe(from, this.solids), this.names);
  }

  /** Take note of the time: whoever stands still is told, once, by a screen reader. */
  private turn(now_ms: number): void {
    const from = this.standpoint();
    if (from === null) this.since = null;
    else if (this.since === null || isElsewhere(this.since.from, from)) {
      this.since = { from, t_ms: now_ms };
      if (now_ms - this.shown_ms > SHOWN_MS) tell(this.panel, null);
    } else if (now_ms - this.since.t_ms > STILL_MS && this.panel.hidden) {
      const words = this.words();
      if (this.live.textContent !== words) this.live.textContent = words;
    }
  }

  /** Show the description and read it aloud, where there is a voice on this device itself. */
  private speak(): void {
    const words = this.words();
    tell(this.panel, words);
    this.shown_ms = performance.now();
    this.live.textContent = words;
    if (!("speechSynthesis" in window)) return;
    speechSynthesis.cancel();
    // a voice from elsewhere would be asked over the network
    const voice = speechSynthesis.getVoices().find((one) => one.localService && one.lang.startsWith(language()));
    if (voice === undefined) return;
    const utterance = new SpeechSynthesisUtterance(words);
    utterance.voice = voice;
    utterance.lang = voice.lang;
    speechSynthesis.speak(utterance);
  }
}

function isElsewhere(a: Standpoint, b: Standpoint): boolean {
  const turn_rad = b.heading_rad - a.heading_rad;
  return (
    Math.hypot(b.e_m - a.e_m, b.n_m - a.n_m, b.u_m - a.u_m) > STILL_M ||
    Math.abs(Math.atan2(Math.sin(turn_rad), Math.cos(turn_rad))) > STILL_RAD
  );
}
