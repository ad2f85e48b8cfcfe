/** A replay's page: the picture with the square over it, and around it the walk in time, its curves and its estimators. */

import { adviceOf, headingWords, placeWords } from "../advice";
import { element, tell } from "../dom";
import { say } from "../language/speech";
import { told } from "../language/told";
import { Narrator } from "../narrator";
import type { Session } from "../protocol";
import { Viewer } from "../viewer";
import type { FrameMessage } from "../wire";
import { type Connection, motionColour, motionWords, sentenceFor } from "../words";
import { Charts } from "./charts";
import { Happenings } from "./happenings";
import { type Deed, deedOfKey, pictureAfter, pictureBefore } from "./keys";
import type { Timeline } from "./review";
import { Rivals } from "./rivals";
import type { Source } from "./source";
import { Strip } from "./strip";
import { Transport } from "./transport";

const TOLD_FOR_MS = 6000;

export class ReplayPage {
  readonly viewer: Viewer;
  readonly ready: Promise<void>;
  session: Session | null = null;
  private readonly strip = new Strip((position_s) => this.go(position_s));
  private readonly transport = new Transport((deed) => this.act(deed));
  private readonly charts = new Charts(element("charts", HTMLElement), (position_s) => this.go(position_s));
  private readonly happenings = new Happenings((position_s) => this.go(position_s));
  private readonly rivals: Rivals;
  private readonly narrator = new Narrator(() => this.viewer.standpoint);
  private readonly notice = element("notice", HTMLElement);
  private readonly toast = element("toast", HTMLElement);
  private timeline: Timeline | null = null;
  private isLearned = false;
  private connection: Connection = "connecting";
  private toastTimer: number | undefined;
  /** Where the picture is that is shown now, or that was asked for since. */
  private position_s = 0;
  private firstFrame: () => void = () => undefined;

  constructor(private readonly source: Source) {
    const drawn = new Promise<void>((resolve) => {
      this.firstFrame = resolve;
    });
    this.viewer = new Viewer(element("view", HTMLCanvasElement), new URLSearchParams(location.search), {
      aligning: false,
      holds: false,
      done: (frameId) => source.done(frameId),
      drawn: (frame) => this.drawn(frame),
      back: () => undefined,
    });
    this.rivals = new Rivals(
      element("rivals", HTMLTableSectionElement),
      element("rivals-note", HTMLElement),
      (estimator) => source.course(estimator),
      (chosen) => {
        this.charts.show(chosen);
        this.colour();
      },
      (estimator) => this.act({ action: "estimator", value: estimator }),
    );
    this.controls();
    this.ready = Promise.all([this.loadSquare(), drawn]).then(() => undefined);
    void this.learn();
    this.listen();
    const loop = (now_ms: number): void => {
      this.turn(now_ms);
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  private listen(): void {
    element("walk", HTMLElement).textContent = this.source.name;
    document.title = say("ar.title_of", { walk: this.source.name });
    this.source.start({
      session: (session) => this.take(session),
      picture: (bytes) => this.viewer.take(bytes),
      garbled: (bytes) => (bytes === null ? this.viewer.noteGarbled() : this.viewer.garbled(bytes)),
      refused: (reason) => this.announce(reason === null ? say("ar.offline") : told(reason)),
      connection: (state) => {
        this.connection = state;
      },
    });
  }

  private async loadSquare(): Promise<void> {
    try {
      const site = await this.source.site();
      element("credit", HTMLElement).textContent = site.attribution;
      this.narrator.learn(site.monuments);
      await this.viewer.show(site);
    } catch (error) {
      this.viewer.model = "failed";
      console.warn("the model could not be loaded", error);
    }
  }

  /** Take what is told of the walk as a whole: its events first, its pictures when they come. */
  private async learn(): Promise<void> {
    try {
      this.timeline = await this.source.timeline();
      this.strip.learn(this.timeline);
      this.happenings.show(this.timeline);
      this.strip.illustrate(await this.source.thumbnails());
    } catch (error) {
      console.warn("the timeline stays bare", error);
    }
    this.isLearned = true;
    if (this.session) this.rivals.begin();
  }

  private take(session: Session): void {
    this.transport.show(session);
    const isFirst = this.session === null;
    this.session = session;
    this.viewer.look.utcOffset_s = session.utc_offset_s;
    this.rivals.show(session);
    // what takes long comes last
    if (isFirst && this.isLearned) this.rivals.begin();
    this.strip.last(session.duration_s);
    if (session.playback) this.at(session.playback.position_s);
    this.colour();
  }

  private drawn(frame: FrameMessage): void {
    this.at(frame.position_s);
    this.caption(frame);
    this.firstFrame();
  }

  /** Show where in the walk the picture is. */
  private at(position_s: number): void {
    this.position_s = position_s;
    this.strip.at(position_s);
    this.transport.at(position_s);
    this.charts.at(position_s);
    this.happenings.at(position_s);
  }

  /** Colour the timeline by the motion models of the estimator that the picture is drawn by. */
  private colour(): void {
    this.strip.colour(this.rivals.courseOf(this.session?.estimator ?? ""));
  }

  /** Say how well the tracker knows what it draws. */
  private caption({ pose }: FrameMessage): void {
    const words = pose
      ? [placeWords(pose), headingWords(pose), pose.motionModel && motionWords(pose.motionModel, pose.estimator)]
      : [];
    for (const [index, id] of ["place", "heading", "motion"].entries()) {
      const target = element(id, HTMLElement);
      tell(target, words[index] || null);
      if (target.parentElement) target.parentElement.hidden = target.hidden;
    }
    element("motion", HTMLElement).style.setProperty("--motion", motionColour(pose?.motionModel ?? null));
    const { style, nearEdge } = this.viewer.overlay;
    const shown = { style, nearEdge, pose: this.viewer.locked, kind: "replay", aligning: false } as const;
    tell(element("advice", HTMLElement), adviceOf(shown));
  }

  private act(deed: Deed): void {
    if (deed.action === "help") this.help();
    else if (deed.action === "step") this.step(deed.direction);
    else this.source.ask(deed);
  }

  private go(position_s: number): void {
    this.act({ action: "seek", value: position_s });
  }

  /** Go one picture on, or back; a walk that plays is stopped for that. */
  private step(direction: 1 | -1): void {
    const pictures_s = this.timeline?.pictures_s ?? [];
    const position_s = (direction === 1 ? pictureAfter : pictureBefore)(pictures_s, this.position_s);
    if (this.session?.playback?.playing) this.act({ action: "pause", value: null });
    if (position_s !== null) this.go(position_s);
  }

  private help(): void {
    const sheet = element("help", HTMLDialogElement);
    if (!sheet.open) {
      sheet.showModal();
      return;
    }
    const { activeElement } = document;
    sheet.close();
    // what is gone must not have the next key
    if (activeElement instanceof HTMLElement && sheet.contains(activeElement)) activeElement.blur();
  }

  private turn(now_ms: number): void {
    const { viewer, session } = this;
    viewer.turn(now_ms);
    const words = sentenceFor({
      connection: this.connection,
      kind: "replay",
      playing: session?.playback?.playing ?? true,
      sincePicture_ms: viewer.lastPicture_ms === null ? null : now_ms - viewer.lastPicture_ms,
      sinceOpened_ms: now_ms,
      hasPose: viewer.pose !== null,
      headingKnown: viewer.pose?.headingKnown ?? false,
      notice: session?.notice ?? null,
      health: {},
      model: viewer.model,
      drawingLost: viewer.drawingLost,
      garbled: viewer.isGarbled(now_ms),
      asked: this.source.name,
    });
    tell(this.notice, words);
  }

  /** Show an error, or news, for a few seconds. */
  private announce(text: string): void {
    tell(this.toast, text);
    window.clearTimeout(this.toastTimer);
    this.toastTimer = window.setTimeout(() => tell(this.toast, null), TOLD_FOR_MS);
  }

  private controls(): void {
    const past = element("past", HTMLInputElement);
    const apply = (): void => {
      past.ariaValueText = past.value === "0" ? say("past.none") : say("past.share", { percent: Number(past.value) });
      this.viewer.setPast(Number(past.value) / 100);
    };
    past.oninput = apply;
    apply();
    element("compare", HTMLButtonElement).onclick = () => void this.rivals.compareAll();
    element("help-close", HTMLButtonElement).onclick = () => this.help();
    window.addEventListener("keydown", (event) => this.key(event));
  }

  private key(event: KeyboardEvent): void {
    const { key, shiftKey, ctrlKey, metaKey, altKey } = event;
    const playback = this.session?.playback;
    if (ctrlKey || metaKey || altKey || !playback || isTheirs(event)) return;
    const deed = deedOfKey(key, shiftKey, { ...playback, position_s: this.position_s }, this.session?.duration_s ?? 0);
    if (deed === null) return;
    event.preventDefault();
    this.act(deed);
  }
}

/** Whether the focused element has a use of its own for the key. */
function isTheirs({ key, target }: KeyboardEvent): boolean {
  if (document.querySelector("dialog[open]")) return key !== "?";
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement) return key === " " || key === "Enter";
  if (!(target instanceof HTMLInputElement) || target.id === "seek") return false;
  return target.type === "checkbox"
    ? key === " "
    : target.type === "radio"
      ? key === " " || key.startsWith("Arrow")
      : true;
}
