/** "Walking now": who walks, how surely, who else watches, and the ways to be with them. DOM only. */

import { say } from "../language/speech";
import type { Session } from "../protocol";
import { metresText, motionColour, motionWords } from "../words";
import type { Way } from "./gaze";
import type { Guest } from "./guest";
import "./beside.css";

export interface Wishes {
  go(name: string, way: Way): void;
  leave(): void;
  /** Whether one shows the others where one looks from has changed. */
  showing(): void;
}

const NARROW_PX = 700;
/** Numbers that change faster are not read. */
const TOLD_EACH_MS = 400;

interface Row {
  readonly item: HTMLLIElement;
  readonly name: HTMLElement;
  readonly detail: HTMLElement;
  readonly doubt: HTMLElement;
  readonly buttons: ReadonlyMap<Way, HTMLButtonElement>;
}

export class Panel {
  private readonly panel = document.createElement("details");
  private readonly list = document.createElement("ul");
  private readonly count = document.createElement("span");
  private readonly company = document.createElement("p");
  private readonly shows = document.createElement("input");
  private readonly rows = new Map<string, Row>();
  private told_ms = 0;

  constructor(private readonly wishes: Wishes) {
    const title = document.createElement("h2");
    title.textContent = say("beside.title");
    const summary = document.createElement("summary");
    summary.append(title, this.count);
    this.company.className = "quiet";
    this.shows.type = "checkbox";
    this.shows.checked = true;
    this.shows.onchange = () => wishes.showing();
    const label = document.createElement("label");
    label.append(this.shows, say("beside.show_me"));
    this.panel.id = "beside";
    this.panel.className = "panel";
    this.panel.hidden = true;
    this.panel.open = innerWidth >= NARROW_PX;
    this.panel.append(summary, this.list, this.company, label);
    // after the page's title and before its tools: also for who goes by keys
    (document.querySelector("header") ?? document.body).after(this.panel);
  }

  /** Whether the others may see where one looks from. */
  get isShowing(): boolean {
    return this.shows.checked;
  }

  /** Show these walkers, with whom one goes, and with whom one is. */
  show(
    guests: readonly Guest[],
    escort: { readonly name: string; readonly way: Way } | null,
    mine: Guest | null,
  ): void {
    this.panel.hidden = guests.length === 0;
    this.count.textContent = guests.length > 1 ? String(guests.length) : "";
    for (const [name, { item }] of this.rows) {
      if (guests.some(({ walk }) => walk.name === name)) continue;
      item.remove();
      this.rows.delete(name);
    }
    for (const { walk } of guests) {
      const row = this.rows.get(walk.name) ?? this.make(walk.name);
      row.name.textContent = nameOf(walk.session);
      for (const [way, button] of row.buttons) {
        const isOn = escort?.name === walk.name && escort.way === way;
        button.dataset["on"] = String(isOn);
        button.textContent = isOn ? say("beside.leave") : say(WORDS[way]);
        // several walkers have the same buttons
        button.setAttribute("aria-label", `${button.textContent}: ${row.name.textContent}`);
      }
    }
    const watching = mine?.walk.watching ?? 0;
    this.company.hidden = watching < 2;
    if (watching > 1) this.company.textContent = say("beside.watching", { count: watching });
  }

  /** Say how the walkers are, now and then. */
  turn(guests: readonly Guest[], now_ms: number): void {
    if (now_ms - this.told_ms < TOLD_EACH_MS) return;
    this.told_ms = now_ms;
    for (const guest of guests) {
      const row = this.rows.get(guest.walk.name);
      if (!row) continue;
      [row.detail.textContent, row.doubt.textContent] = wordsOf(guest, now_ms);
      row.item.style.setProperty("--motion", motionColour(guest.shown?.told.motionModel ?? null));
    }
  }

  private make(name: string): Row {
    const [item, title] = [document.createElement("li"), document.createElement("strong")];
    const [detail, doubt] = [document.createElement("p"), document.createElement("p")];
    const buttons = new Map<Way, HTMLButtonElement>();
    const ways = document.createElement("div");
    for (const way of ["follow", "eyes"] as const) {
      const button = document.createElement("button");
      button.type = "button";
      button.onclick = () => (button.dataset["on"] === "true" ? this.wishes.leave() : this.wishes.go(name, way));
      buttons.set(way, button);
      ways.append(button);
    }
    detail.className = "how quiet";
    doubt.className = "quiet";
    item.append(title, detail, doubt, ways);
    this.list.append(item);
    const row = { item, name: title, detail, doubt, buttons };
    this.rows.set(name, row);
    return row;
  }
}

const WORDS = { follow: "beside.follow", eyes: "beside.eyes" } as const;

/** A recording is not taken for somebody who walks there now. */
function nameOf({ kind, title, log, name }: Session): string {
  return kind === "live" ? (title ?? name) : say("beside.recording", { name: title ?? log ?? name });
}

/** Return how a walker is, and how surely they are there. */
function wordsOf({ walk, shown }: Guest, now_ms: number): readonly [string, string] {
  if (walk.connection !== "open") return [say("beside.lost"), ""];
  if (shown === null) return [say("beside.waiting"), ""];
  const { playback } = walk.session;
  if (playback !== null && !playback.playing) return [say("beside.paused"), ""];
  if (!walk.isHeard(now_ms)) return [say("beside.silent"), ""];
  const [east_m2 = 0, north_m2 = 0] = shown.told.variance;
  const far = say("beside.within", { far: metresText(Math.sqrt(Math.max(east_m2, north_m2))) });
  const { motionModel } = shown.told;
  return motionModel === null ? [far, ""] : [motionWords(motionModel, walk.session.estimator), far];
}
