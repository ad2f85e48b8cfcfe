/** The AR page: one session's pictures, each with the square drawn by the pose of that same picture. */

import { Bar } from "./bar";
import { Composite } from "./composite";
import { canDraw, element } from "./dom";
import { invertRigid, T_gltf_site, transform, type Vector3 } from "./frames";
import { Hud } from "./hud";
import { project } from "./lens";
import { loadSquare } from "./model";
import type { Request } from "./playback";
import { parseSessions, parseSite, parseState, type Session } from "./protocol";
import { Link } from "./socket";
import { decodeFrame, type FrameMessage, magicOf, WireError } from "./wire";
import type { Connection } from "./words";

/** The real ground is there already: the model's is only a hint of its paving. */
const GROUND_SHARE = 0.25;
const LOOK_AGAIN_MS = 2000;

class Page {
  readonly composite = new Composite(element("view", HTMLCanvasElement));
  readonly hud = new Hud();
  readonly ready: Promise<void>;
  frame: FrameMessage | null = null;
  session: Session | null = null;
  framesDrawn = 0;
  posesDrawn = 0;
  mismatched = 0;
  private link: Link | null = null;
  private readonly bar = new Bar((request) => this.ask(request));
  private connection: Connection = "connecting";
  private waiting: { message: FrameMessage; bitmap: ImageBitmap; arrived_ms: number } | null = null;
  private newest: { bytes: ArrayBuffer; arrived_ms: number } | null = null;
  private decoding = false;
  private shown: ImageBitmap | null = null;
  private lastPicture_ms: number | null = null;
  private modelFailed = false;
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
      const site = parseSite(await (await fetch("/api/site")).json());
      element("credit", HTMLElement).textContent = site.attribution;
      const url = site.models["roman"];
      if (url === undefined) throw new Error("no model named roman");
      this.composite.show(await loadSquare(url, GROUND_SHARE));
      this.composite.redraw();
    } catch (error) {
      this.modelFailed = true;
      console.warn("the model could not be loaded", error);
    }
  }

  private async join(): Promise<void> {
    const name = await sessionName();
    if (name === null) {
      this.connection = "no session";
      window.setTimeout(() => void this.join(), LOOK_AGAIN_MS);
      return;
    }
    element("walk", HTMLElement).textContent = name;
    const url = new URL(`/ws/view/${encodeURIComponent(name)}${location.search}`, location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.link = new Link(url.href, {
      connection: (state) => {
        this.connection = state;
        if (state === "open") this.hud.age.reset();
      },
      text: (text) => this.text(text),
      binary: (bytes) => {
        if (magicOf(bytes) !== "AGF1") return;
        const older = this.newest;
        this.newest = { bytes, arrived_ms: performance.now() };
        if (older) this.acknowledgeUnread(older.bytes);
        void this.decode();
      },
    });
  }

  private text(text: string): void {
    const message = parseState(text);
    if (message?.type === "session") {
      this.session = message.session;
      this.bar.show(message.session);
    } else if (message?.type === "reply" && !message.reply.ok) {
      this.hud.complain(message.reply.error ?? "That did not work.");
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
      } catch (error) {
        // a picture that does not decode is as good as drawn: else the server would wait for it
        if (error instanceof WireError && error.frameId !== null) this.acknowledge(error.frameId);
        else this.acknowledgeUnread(bytes);
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
    if (next) {
      this.waiting = null;
      this.draw(next.message, next.bitmap, next.arrived_ms, now_ms);
    }
    this.hud.show(this.frame, now_ms);
    this.hud.say({
      connection: this.connection,
      kind: this.session?.kind ?? "replay",
      playing: this.session?.playback?.playing ?? true,
      sincePicture_ms: this.lastPicture_ms === null ? null : now_ms - this.lastPicture_ms,
      sinceOpened_ms: now_ms,
      hasPose: this.frame?.pose != null,
      headingKnown: this.frame?.pose?.headingKnown ?? false,
      notice: this.session?.notice ?? null,
      modelFailed: this.modelFailed,
    });
  }

  private draw(message: FrameMessage, bitmap: ImageBitmap, arrived_ms: number, now_ms: number): void {
    const { pose } = message;
    const fits = pose !== null && pose.frameId === message.frameId;
    if (pose !== null && !fits) this.mismatched += 1;
    this.composite.draw({
      bitmap,
      lens: message.lens,
      quarterTurns: message.quarterTurns,
      T_site_cam: pose && fits && pose.headingKnown ? pose.T_site_cam : null,
    });
    this.shown?.close();
    this.shown = bitmap;
    this.frame = message;
    this.framesDrawn += 1;
    if (fits) this.posesDrawn += 1;
    this.lastPicture_ms = now_ms;
    this.hud.rate.count(now_ms);
    this.hud.age.drawn(message.t_sent_ns, arrived_ms);
    this.bar.at(message.position_s);
    this.acknowledge(message.frameId);
    this.firstFrame();
  }

  private ask(request: Request): void {
    this.requests += 1;
    if (!this.link?.send({ type: "control", request_id: `v${this.requests}`, ...request }))
      this.hud.complain("There is no connection just now.");
  }

  private controls(): void {
    const canvas = element("view", HTMLCanvasElement);
    const past = element("past", HTMLInputElement);
    const fill = (): void => this.composite.resize(canvas.clientWidth, canvas.clientHeight, window.devicePixelRatio);
    new ResizeObserver(fill).observe(canvas);
    fill();
    past.oninput = () => this.setPast(Number(past.value) / 100);
    this.setPast(Number(past.value) / 100);
    window.addEventListener("keydown", ({ key, ctrlKey, metaKey }) => {
      if (key === "h" && !ctrlKey && !metaKey) document.body.classList.toggle("clean");
    });
    canvas.focus();
  }

  setPast(share: number): void {
    this.composite.past = Math.min(1, Math.max(0, share));
    this.composite.redraw();
  }
}

/** Return the session of the address, else the newest one; null where there is none. */
async function sessionName(): Promise<string | null> {
  const replay = /^\/replay\/([^/]+)\/?$/.exec(location.pathname)?.[1];
  if (replay !== undefined) return decodeURIComponent(replay);
  const asked = new URLSearchParams(location.search).get("session");
  if (asked !== null) return asked;
  try {
    const sessions = parseSessions(await (await fetch("/api/sessions")).json());
    return sessions.at(-1)?.name ?? null;
  } catch {
    return null;
  }
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
      lastPoseFrameId: page.frame?.pose?.frameId ?? null,
      poseAgeMs: page.hud.age.at(performance.now()),
      motionModel: page.frame?.pose?.motionModel ?? null,
      estimator: page.frame?.pose?.estimator ?? null,
      overlay: page.frame?.pose ? "locked" : "none",
      drawCalls: page.composite.cost.calls,
      triangles: page.composite.cost.triangles,
    }),
    project: (point: Vector3) => {
      const frame = page.frame;
      if (!frame?.pose) return null;
      return project(frame.lens, transform(invertRigid(frame.pose.T_site_cam), point));
    },
    pose: () => {
      const pose = page.frame?.pose;
      return pose
        ? { t_ns: pose.t_ns, frameId: pose.frameId, T_site_cam: pose.T_site_cam, cov: pose.covariance }
        : null;
    },
    session: () => page.session,
    setPast: (share: number) => page.setPast(share),
    debugTargets: (points: Vector3[], colours: string[]) => {
      page.composite.mark(
        points.map((point) => transform(T_gltf_site, point)),
        colours,
      );
      page.setPast(1);
    },
    readPixels: (x: number, y: number, width: number, height: number) => page.composite.read(x, y, width, height),
  };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}

if (canDraw(element("notice", HTMLElement))) publish(new Page());
