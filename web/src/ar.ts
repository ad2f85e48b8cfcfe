/** The AR page: one session's pictures, each with the square drawn by the pose of that same picture. */

import "./everyone";
import { Raycaster, Vector3 as Vector } from "three";
import { Align, type Host } from "./align";
import type { Alignment } from "./alignment";
import { Bar } from "./bar";
import { Care } from "./care";
import { Choices } from "./choices";
import { clockOff, clockWords } from "./clock";
import { deedsOf } from "./deeds";
import { canDraw, element, publishNothing, tell } from "./dom";
import { T_gltf_site, transform, type Vector3 } from "./frames";
import { Guide } from "./guide";
import { Hmd, worn } from "./hmd";
import { Hud } from "./hud";
import { languages, say } from "./language/speech";
import { told } from "./language/told";
import { SiteMap } from "./map";
import { Narrator } from "./narrator";
import { GHOST } from "./overlay";
import type { Request } from "./playback";
import { parseState, type Session } from "./protocol";
import { askedName, newestName } from "./session";
import { type ShareRequest, Sharing } from "./sharing";
import { parseSite, type Site } from "./site";
import { Link } from "./socket";
import { publishViewer } from "./support";
import { type Audience, fieldOf, Viewer } from "./viewer";
import { type FrameMessage, magicOf } from "./wire";
import { type Connection, newsOf } from "./words";

const LOOK_AGAIN_MS = 2000;
/** Before a model that did not come is asked for again: at first, and at most. */
const MODEL_WAIT_MS = [3000, 60_000] as const;
class Page {
  readonly viewer = new Viewer(
    element("view", HTMLCanvasElement),
    new URLSearchParams(location.search),
    this.audience(),
  );
  readonly hud = new Hud();
  readonly ready: Promise<void>;
  session: Session | null = null;
  private readonly guide = new Guide();
  private readonly care = new Care();
  private readonly sharing = new Sharing((request) => this.ask(request));
  private readonly align = new Align(element("view", HTMLCanvasElement), this.host());
  readonly choices = new Choices(
    this.viewer.look,
    (share) => this.viewer.setPast(share),
    () => this.viewer.composite.redraw(),
  );
  private readonly narrator = new Narrator(() => this.viewer.standpoint);
  private readonly hmd = this.wear();
  private link: Link | null = null;
  private readonly bar = new Bar((request) => this.ask(request));
  private connection: Connection = "connecting";
  private modelWait_ms: number = MODEL_WAIT_MS[0];
  private readonly asked = askedName();
  private requests = 0;
  private firstFrame: () => void = () => undefined;

  constructor() {
    const drawn = new Promise<void>((resolve) => {
      this.firstFrame = resolve;
    });
    this.ready = Promise.all([this.loadModel(), drawn]).then(() => undefined);
    this.controls();
    void this.join();
    const loop = (): void => {
      this.turn(performance.now());
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  private async loadModel(): Promise<void> {
    try {
      const answer = await fetch("/api/site");
      this.setClock(answer.headers.get("date"));
      const site = parseSite(await answer.json(), languages(navigator.languages));
      element("credit", HTMLElement).textContent = site.attribution;
      this.learn(site);
      await this.viewer.show(site);
      if (this.viewer.square) this.choices.show(site, this.viewer.square);
    } catch (error) {
      this.viewer.model = "failed";
      console.warn("the model could not be loaded", error);
      window.setTimeout(() => void this.loadModel(), this.modelWait_ms);
      this.modelWait_ms = Math.min(2 * this.modelWait_ms, MODEL_WAIT_MS[1]);
    }
  }

  /** Take from the site what the panels must know of it. */
  private learn(site: Site): void {
    const outlines = site.monuments.map(({ footprint }) => footprint).filter((footprint) => footprint.length > 2);
    this.align.learn(site);
    this.narrator.learn(site.monuments);
    this.guide.map = new SiteMap(element("plan", HTMLElement), outlines);
  }

  private async join(): Promise<void> {
    const name = this.asked ?? (await newestName());
    if (name === null) {
      this.connection = "no session";
      window.setTimeout(() => void this.join(), LOOK_AGAIN_MS);
      return;
    }
    element("walk", HTMLElement).textContent = name;
    document.title = say("ar.title_of", { walk: name });
    const url = new URL(`/ws/view/${encodeURIComponent(name)}${location.search}`, location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.link = new Link(url.href, {
      connection: (state) => {
        this.connection = state;
        if (state === "open") this.viewer.age.reset();
      },
      text: (text) => this.text(text),
      binary: (bytes) => (magicOf(bytes) === "AGF1" ? this.viewer.take(bytes) : this.viewer.garbled(bytes)),
    });
  }

  private text(text: string): void {
    try {
      this.take(parseState(text));
    } catch (error) {
      this.viewer.noteGarbled();
      console.warn("a message was left out", error);
    }
  }

  private take(message: ReturnType<typeof parseState>): void {
    if (message?.type === "session") {
      const news = this.session && newsOf(this.session.health, message.session.health);
      if (news) this.hud.announce(news);
      this.session = message.session;
      this.viewer.look.utcOffset_s = message.session.utc_offset_s;
      this.bar.show(message.session);
      this.care.show(message.session);
      this.sharing.show(message.session, message.role);
    } else if (message?.type === "company") {
      const others = message.watching - 1;
      tell(element("watching", HTMLElement), others > 0 ? say("ar.others", { count: others }) : null);
    } else if (message?.type === "reply" && !this.align.replied(message.reply) && !message.reply.ok) {
      this.hud.announce(message.reply.error === null ? say("ar.did_not_work") : told(message.reply.error));
    }
  }

  private turn(now_ms: number): void {
    const { viewer } = this;
    viewer.turn(now_ms);
    const { frame, locked } = viewer;
    if (frame) this.hmd?.turn(locked?.headingKnown ? locked.T_site_cam : null, fieldOf(frame), now_ms);
    const playing = this.session?.playback?.playing ?? true;
    this.hud.show(frame, this.viewer.age.at(now_ms), playing, now_ms);
    this.hud.advise({
      style: viewer.overlay.style,
      nearEdge: viewer.overlay.nearEdge,
      pose: locked,
      kind: this.session?.kind ?? "replay",
      aligning: this.align.active,
    });
    this.hud.say({
      connection: this.connection,
      kind: this.session?.kind ?? "replay",
      playing,
      sincePicture_ms: viewer.lastPicture_ms === null ? null : now_ms - viewer.lastPicture_ms,
      sinceOpened_ms: now_ms,
      hasPose: frame?.pose != null,
      headingKnown: frame?.pose?.headingKnown ?? false,
      notice: this.session?.notice ?? null,
      health: this.session?.health ?? {},
      model: viewer.model,
      drawingLost: viewer.drawingLost,
      garbled: viewer.isGarbled(now_ms),
      asked: this.asked,
    });
  }

  /** What the page does with the pictures that are drawn. */
  private audience(): Audience {
    const page = this;
    return {
      get aligning() {
        return page.align.active;
      },
      get holds() {
        return page.align.holds;
      },
      done: (frameId) => this.link?.send({ type: "ack", frame_id: frameId }),
      drawn: (frame, now_ms) => this.drawn(frame, now_ms),
      back: (longAway) => {
        if (longAway) this.hud.announce(say("ar.back"));
      },
    };
  }

  private drawn(frame: FrameMessage, now_ms: number): void {
    this.guide.show(frame, this.viewer.overlay);
    this.choices.tellSun(this.viewer.look.sun);
    this.hud.rate.count(now_ms);
    this.bar.at(frame.position_s);
    this.align.drawn(frame);
    this.firstFrame();
  }

  /** Ask the rig for something; return the request's name, or null where there is no connection. */
  private ask(request: Request | { action: "align"; value: Alignment } | ShareRequest): string | null {
    this.requests += 1;
    const name = `v${this.requests}`;
    if (this.link?.send({ type: "control", request_id: name, ...request })) return name;
    this.hud.announce(say("ar.offline"));
    return null;
  }

  /** What an alignment may ask of the page. */
  private host(): Host {
    const page = this;
    return {
      get frame() {
        return page.viewer.frame;
      },
      get doubt() {
        return page.viewer.overlay.doubt;
      },
      align: (value) => this.ask({ action: "align", value }),
      preview: (T_site_cam) => {
        const { composite, overlay } = this.viewer;
        composite.laying = T_site_cam === null ? overlay.laying : GHOST;
        composite.preview(T_site_cam);
      },
      modelPoint: (sight) => this.modelPoint(sight),
      announce: (text) => this.hud.announce(text),
    };
  }

  /** Return the point of the drawn model in that direction from the present eye, site axes. */
  private modelPoint(sight: Vector3): Vector3 | null {
    const { locked, square } = this.viewer;
    if (!locked || !square) return null;
    const eye = transform(T_gltf_site, transform(locked.T_site_cam, [0, 0, 0]));
    const way = transform(T_gltf_site, sight);
    const hit = square.hit(new Raycaster(new Vector(...eye), new Vector(...way)));
    return hit && [hit.x, -hit.z, hit.y];
  }

  /** Put this device's clock right by the server's. */
  private setClock(serverDate: string | null): void {
    const { look } = this.viewer;
    look.clockOff_s = clockOff(serverDate, Date.now());
    const words = clockWords(look.clockOff_s);
    if (words) this.hud.announce(words);
  }

  /** Be a head-mounted display's page, where the address asks for that. */
  private wear(): Hmd | null {
    const wearing = worn(new URLSearchParams(location.search));
    if (wearing === null) return null;
    this.viewer.composite.apart_m = wearing.eyes === 2 ? wearing.ipd_m : null;
    const sayings = ["notice", "toast", "way-words"].map((id) => element(id, HTMLElement));
    return new Hmd(wearing, () => deedsOf(this.choices, this.session, (request) => this.ask(request)), sayings);
  }

  private controls(): void {
    const canvas = element("view", HTMLCanvasElement);
    const { classList } = document.body;
    element("hide", HTMLButtonElement).onclick = () => classList.add("clean");
    canvas.onclick = () => classList.remove("clean");
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey, target }) => {
      // a list of choices jumps to the letter that is typed
      if (key === "h" && !ctrlKey && !metaKey && !(target instanceof HTMLSelectElement)) classList.toggle("clean");
    });
  }
}

/** What tests of this page see besides. */
function publish(page: Page): void {
  const { viewer } = page;
  publishViewer(page, {
    time: (count: number) => viewer.look.time(count),
    debugTargets: (points: Vector3[], colours: string[], hideable = false) => {
      viewer.composite.mark(
        points.map((point) => transform(T_gltf_site, point)),
        colours,
        hideable,
      );
      viewer.setPast(1);
    },
  });
}

if (canDraw(element("notice", HTMLElement))) publish(new Page());
else publishNothing();
