/** The AR page: one session's pictures, each with the square drawn by the pose of that same picture. */

import "./everyone";
import { Raycaster, Vector3 as Vector } from "three";
import { Align, type Host } from "./align";
import type { Alignment } from "./alignment";
import { Bar } from "./bar";
import { Care } from "./care";
import { Choices } from "./choices";
import { clockOff, clockWords } from "./clock";
import { Composite } from "./composite";
import { deedsOf } from "./deeds";
import type { Standpoint } from "./describe";
import { canDraw, element, publishNothing, tell } from "./dom";
import { headingOf, invertRigid, T_gltf_site, transform, type Vector3 } from "./frames";
import { Guide } from "./guide";
import { Hmd, worn } from "./hmd";
import { Hud } from "./hud";
import { watchInterruptions } from "./interruptions";
import { languages, say } from "./language/speech";
import { project } from "./lens";
import { Look } from "./look";
import { SiteMap } from "./map";
import { Square } from "./model";
import { Narrator } from "./narrator";
import { loadOccluders } from "./occluders";
import { GHOST, NOTHING, type Overlay, Overlays, seenThrough } from "./overlay";
import type { Request } from "./playback";
import { parseState, type Session } from "./protocol";
import { askedName, newestName } from "./session";
import { type ShareRequest, Sharing } from "./sharing";
import { parseSite, type Site } from "./site";
import { Link } from "./socket";
import { loadEdges } from "./walkable";
import { type CameraPose, decodeFrame, type FrameMessage, magicOf, WireError } from "./wire";
import { type Connection, newsOf, type Situation } from "./words";

/** The real ground is there already: the model's is only a hint of its paving. */
const GROUND_SHARE = 0.25;
const LOOK_AGAIN_MS = 2000;
/** Before a model that did not come is asked for again: at first, and at most. */
const MODEL_WAIT_MS = [3000, 60_000] as const;
/** A message that cannot be read is told of for so long. */
const GARBLED_FOR_MS = 4000;
/** Whatever is as long may have been a picture. */
const LONG_MESSAGE_BYTES = 384;

class Page {
  readonly composite = new Composite(element("view", HTMLCanvasElement));
  readonly hud = new Hud();
  readonly look = new Look(this.composite, new URLSearchParams(location.search));
  readonly ready: Promise<void>;
  frame: FrameMessage | null = null;
  overlay: Overlay = NOTHING;
  session: Session | null = null;
  square: Square | null = null;
  framesDrawn = 0;
  posesDrawn = 0;
  mismatched = 0;
  private readonly overlays = new Overlays();
  private readonly guide = new Guide();
  private readonly care = new Care();
  private readonly sharing = new Sharing((request) => this.ask(request));
  private readonly align = new Align(element("view", HTMLCanvasElement), this.host());
  readonly choices = new Choices(
    this.look,
    (share) => this.setPast(share),
    () => this.composite.redraw(),
  );
  private readonly narrator = new Narrator(() => this.standpoint);
  private readonly hmd = this.wear();
  private link: Link | null = null;
  private readonly bar = new Bar((request) => this.ask(request));
  private connection: Connection = "connecting";
  private waiting: { message: FrameMessage; bitmap: ImageBitmap; arrived_ms: number } | null = null;
  private newest: { bytes: ArrayBuffer; arrived_ms: number } | null = null;
  private decoding = false;
  /** Whether nothing was drawn since the screen was. */
  private isFree = false;
  private shown: ImageBitmap | null = null;
  private lastPicture_ms: number | null = null;
  private model: Situation["model"] = "loading";
  private modelWait_ms: number = MODEL_WAIT_MS[0];
  private drawingLost = false;
  private garbled_ms = Number.NEGATIVE_INFINITY;
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
      this.isFree = true;
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
      void this.learn(site);
      const levels = site.models["roman"];
      if (!levels) throw new Error("no model named roman");
      const square = await Square.load(levels, GROUND_SHARE);
      for (const { id, defaultVariant } of site.monuments)
        if (defaultVariant !== null) square.showVariant(id, defaultVariant);
      this.square = square;
      this.look.show(square, site.origin);
      this.composite.show(square);
      this.choices.show(site, square);
      this.model = "shown";
      if (site.occluders !== null)
        void loadOccluders(site.occluders).then((group) => square.hideBehind(group), notHidden);
    } catch (error) {
      this.model = "failed";
      console.warn("the model could not be loaded", error);
      window.setTimeout(() => void this.loadModel(), this.modelWait_ms);
      this.modelWait_ms = Math.min(2 * this.modelWait_ms, MODEL_WAIT_MS[1]);
    }
  }

  /** Take from the site what the overlay must know of it: its plan, and where its edges are. */
  private async learn(site: Site): Promise<void> {
    const outlines = site.monuments.map(({ footprint }) => footprint).filter((footprint) => footprint.length > 2);
    this.align.learn(site);
    this.narrator.learn(site.monuments);
    this.guide.map = new SiteMap(element("plan", HTMLElement), outlines);
    this.overlays.eyeHeight_m = site.eye_height_m;
    try {
      if (site.walkable !== null) this.overlays.edges = await loadEdges(site.walkable);
    } catch (error) {
      console.warn("the overlay does not know where the site has drops and steps", error);
    }
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
        if (state === "open") this.hud.age.reset();
      },
      text: (text) => this.text(text),
      binary: (bytes) => {
        if (magicOf(bytes) !== "AGF1") return this.garbled(bytes);
        const older = this.newest;
        this.newest = { bytes, arrived_ms: performance.now() };
        if (older) this.acknowledgeUnread(older.bytes);
        void this.decode();
      },
    });
  }

  /** Leave out what cannot be read; the server must not wait for it, if it was a picture. */
  private garbled(bytes: ArrayBuffer): void {
    if (bytes.byteLength <= LONG_MESSAGE_BYTES) return;
    this.garbled_ms = performance.now();
    this.acknowledgeUnread(bytes);
  }

  private text(text: string): void {
    try {
      this.take(parseState(text));
    } catch (error) {
      this.garbled_ms = performance.now();
      console.warn("a message was left out", error);
    }
  }

  private take(message: ReturnType<typeof parseState>): void {
    if (message?.type === "session") {
      const news = this.session && newsOf(this.session.health, message.session.health);
      if (news) this.hud.announce(news);
      this.session = message.session;
      this.bar.show(message.session);
      this.care.show(message.session);
      this.sharing.show(message.session, message.role);
    } else if (message?.type === "company") {
      const others = message.watching - 1;
      tell(element("watching", HTMLElement), others > 0 ? say("ar.others", { count: others }) : null);
    } else if (message?.type === "reply" && !this.align.replied(message.reply) && !message.reply.ok) {
      this.hud.announce(message.reply.error ?? say("ar.did_not_work"));
    }
  }

  /** Decode the newest message; whatever arrives meanwhile waits, and only the newest of it is decoded next. */
  private async decode(): Promise<void> {
    if (this.decoding) return;
    this.decoding = true;
    while (this.newest) {
      const { bytes, arrived_ms } = this.newest;
      this.newest = null;
      try {
        const message = decodeFrame(bytes);
        const blob = new Blob([message.jpeg], { type: "image/jpeg" });
        const bitmap = await createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
        if (this.waiting) {
          this.acknowledge(this.waiting.message.frameId);
          this.waiting.bitmap.close();
        }
        this.waiting = { message, bitmap, arrived_ms };
        // at once, but one for each time that the screen is drawn: more would only queue up
        if (this.isFree) this.turn(performance.now());
        this.isFree = false;
      } catch (error) {
        // a picture that does not decode is as good as drawn: else the server would wait for it
        if (error instanceof WireError && error.frameId !== null) this.acknowledge(error.frameId);
        else this.acknowledgeUnread(bytes);
        this.garbled_ms = performance.now();
        console.warn("a picture was left out", error);
      }
    }
    this.decoding = false;
  }

  private acknowledge(frameId: number): void {
    this.link?.send({ type: "ack", frame_id: frameId });
  }

  private acknowledgeUnread(bytes: ArrayBuffer): void {
    if (bytes.byteLength >= 12) this.acknowledge(new DataView(bytes).getUint32(8, true));
  }

  private turn(now_ms: number): void {
    const next = this.waiting;
    if (next && (this.align.holds || this.drawingLost)) {
      this.waiting = null;
      this.acknowledge(next.message.frameId);
      next.bitmap.close();
      this.lastPicture_ms = now_ms;
    } else if (next) {
      this.waiting = null;
      this.draw(next.message, next.bitmap, next.arrived_ms, now_ms);
    }
    if (this.frame)
      this.hmd?.turn(this.locked?.headingKnown ? this.locked.T_site_cam : null, fieldOf(this.frame.lens), now_ms);
    const playing = this.session?.playback?.playing ?? true;
    this.hud.show(this.frame, playing, now_ms);
    this.hud.advise({
      style: this.overlay.style,
      nearEdge: this.overlay.nearEdge,
      pose: this.locked,
      kind: this.session?.kind ?? "replay",
      aligning: this.align.active,
    });
    this.hud.say({
      connection: this.connection,
      kind: this.session?.kind ?? "replay",
      playing,
      sincePicture_ms: this.lastPicture_ms === null ? null : now_ms - this.lastPicture_ms,
      sinceOpened_ms: now_ms,
      hasPose: this.frame?.pose != null,
      headingKnown: this.frame?.pose?.headingKnown ?? false,
      notice: this.session?.notice ?? null,
      health: this.session?.health ?? {},
      model: this.model,
      drawingLost: this.drawingLost,
      garbled: now_ms - this.garbled_ms < GARBLED_FOR_MS,
      asked: this.asked,
    });
  }

  private draw(message: FrameMessage, bitmap: ImageBitmap, arrived_ms: number, now_ms: number): void {
    this.frame = message;
    const { pose, locked } = this;
    this.overlays.aligning = this.align.active;
    this.overlay = this.overlays.take(message, locked);
    this.composite.laying = this.align.active ? seenThrough(this.overlay.laying) : this.overlay.laying;
    this.guide.show(message, this.overlay);
    this.look.before(message, bitmap, now_ms);
    const began_ms = performance.now();
    this.composite.draw({
      bitmap,
      lens: message.lens,
      quarterTurns: message.quarterTurns,
      T_site_cam: this.overlay.T_site_cam,
      doubt: this.overlay.doubt,
    });
    this.look.after(began_ms, arrived_ms);
    this.choices.tellSun(this.look.sun);
    this.shown?.close();
    this.shown = bitmap;
    document.body.classList.remove("empty");
    this.framesDrawn += 1;
    if (locked) this.posesDrawn += 1;
    else if (pose) this.mismatched += 1;
    this.lastPicture_ms = now_ms;
    this.hud.rate.count(now_ms);
    this.hud.age.drawn(message.t_sent_ns, arrived_ms);
    this.bar.at(message.position_s);
    this.align.drawn(message);
    this.acknowledge(message.frameId);
    this.firstFrame();
  }

  get pose(): CameraPose | null {
    return this.frame?.pose ?? null;
  }

  /** The pose of the picture that is drawn now, never that of another one. */
  get locked(): CameraPose | null {
    return this.pose?.frameId === this.frame?.frameId ? this.pose : null;
  }

  /** Where the drawn picture's eye is; null where nobody knows where it looks. */
  private get standpoint(): Standpoint | null {
    const { frame, locked } = this;
    if (!frame || !locked?.headingKnown) return null;
    const [e_m, n_m, u_m] = transform(locked.T_site_cam, [0, 0, 0]);
    return { e_m, n_m, u_m, heading_rad: headingOf(locked.T_site_cam), half_rad: fieldOf(frame.lens) / 2 };
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
        return page.frame;
      },
      get doubt() {
        return page.overlay.doubt;
      },
      align: (value) => this.ask({ action: "align", value }),
      preview: (T_site_cam) => {
        this.composite.laying = T_site_cam === null ? this.overlay.laying : GHOST;
        this.composite.preview(T_site_cam);
      },
      modelPoint: (sight) => this.modelPoint(sight),
      announce: (text) => this.hud.announce(text),
    };
  }

  /** Return the point of the drawn model in that direction from the present eye, site axes. */
  private modelPoint(sight: Vector3): Vector3 | null {
    if (!this.locked || !this.square) return null;
    const eye = transform(T_gltf_site, transform(this.locked.T_site_cam, [0, 0, 0]));
    const way = transform(T_gltf_site, sight);
    const hit = this.square.hit(new Raycaster(new Vector(...eye), new Vector(...way)));
    return hit && [hit.x, -hit.z, hit.y];
  }

  /** Put this device's clock right by the server's. */
  private setClock(serverDate: string | null): void {
    this.look.clockOff_s = clockOff(serverDate, Date.now());
    const words = clockWords(this.look.clockOff_s);
    if (words) this.hud.announce(words);
  }

  /** Be a head-mounted display's page, where the address asks for that. */
  private wear(): Hmd | null {
    const wearing = worn(new URLSearchParams(location.search));
    if (wearing === null) return null;
    this.composite.apart_m = wearing.eyes === 2 ? wearing.ipd_m : null;
    const sayings = ["notice", "toast", "way-words"].map((id) => element(id, HTMLElement));
    return new Hmd(wearing, () => deedsOf(this.choices, this.session, (request) => this.ask(request)), sayings);
  }

  private controls(): void {
    const canvas = element("view", HTMLCanvasElement);
    const fill = (): void => this.composite.resize(canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio);
    new ResizeObserver(fill).observe(canvas);
    fill();
    watchInterruptions(canvas, {
      drawing: (lost) => {
        this.drawingLost = lost;
        if (!lost) this.composite.begin();
      },
      back: (longAway) => {
        this.lastPicture_ms &&= performance.now(); // none was missed but by not looking
        if (longAway) this.hud.announce(say("ar.back"));
      },
    });
    const { classList } = document.body;
    classList.toggle("frugal", this.composite.drawsInSoftware);
    element("hide", HTMLButtonElement).onclick = () => classList.add("clean");
    canvas.onclick = () => classList.remove("clean");
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey, target }) => {
      // a list of choices jumps to the letter that is typed
      if (key === "h" && !ctrlKey && !metaKey && !(target instanceof HTMLSelectElement)) classList.toggle("clean");
    });
  }

  setPast(share: number): void {
    this.composite.past = Math.min(1, Math.max(0, share));
    this.composite.redraw();
  }
}

/** Return how wide a picture is in the display, radians, distortion aside. */
function fieldOf({ width_px, fx_px }: FrameMessage["lens"]): number {
  return 2 * Math.atan(width_px / (2 * fx_px));
}

function notHidden(error: unknown): void {
  console.warn("nothing hides the square", error);
}

/** What tests and support see: read-only but for `mark` and `setPast`. */
function publish(page: Page): void {
  const api = {
    ready: page.ready,
    stats: () => ({
      framesDrawn: page.framesDrawn,
      posesDrawn: page.posesDrawn,
      mismatchedFrames: page.mismatched,
      lastFrameId: page.frame?.frameId ?? null,
      lastPoseFrameId: page.pose?.frameId ?? null,
      poseAgeMs: page.hud.age.at(performance.now()),
      motionModel: page.pose?.motionModel ?? null,
      estimator: page.pose?.estimator ?? null,
      overlay: page.overlay.style,
      drawCalls: page.composite.cost.calls,
      triangles: page.composite.cost.triangles,
      occluders: page.square?.hasOccluders ?? false,
      effort: page.look.effort.name,
      drawMs: page.look.usual_ms,
      sun: page.look.sun,
      gain: page.composite.gain,
    }),
    project: (point: Vector3) => {
      const { frame, locked } = page;
      return frame && locked ? project(frame.lens, transform(invertRigid(locked.T_site_cam), point)) : null;
    },
    pose: () => {
      const { pose } = page;
      return pose && { t_ns: pose.t_ns, frameId: pose.frameId, T_site_cam: pose.T_site_cam, cov: pose.covariance };
    },
    session: () => page.session,
    time: (count: number) => page.look.time(count),
    setPast: (share: number) => page.setPast(share),
    debugTargets: (points: Vector3[], colours: string[], hideable = false) => {
      page.composite.mark(
        points.map((point) => transform(T_gltf_site, point)),
        colours,
        hideable,
      );
      page.setPast(1);
    },
    readPixels: (x: number, y: number, width: number, height: number) => page.composite.read(x, y, width, height),
  };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}

if (canDraw(element("notice", HTMLElement))) publish(new Page());
else publishNothing();
