/** Pictures of a walk on a canvas, each with the square drawn over it by the pose of that same picture. */

import { Composite } from "./composite";
import { Decoder, type Picture } from "./decoding";
import type { Standpoint } from "./describe";
import { headingOf, invertRigid, transform, type Vector3 } from "./frames";
import { watchInterruptions } from "./interruptions";
import { project } from "./lens";
import { Look } from "./look";
import { Square } from "./model";
import { loadOccluders } from "./occluders";
import { NOTHING, type Overlay, Overlays, seenThrough } from "./overlay";
import { PoseAge } from "./playback";
import type { Site } from "./site";
import { loadEdges } from "./walkable";
import { type CameraPose, decodeFrame, type FrameMessage, WireError } from "./wire";
import type { Situation } from "./words";

/** The real ground is there already: the model's is only a hint of its paving. */
const GROUND_SHARE = 0.25;
/** A message that cannot be read is told of for so long. */
const GARBLED_FOR_MS = 4000;
/** Whatever is as long may have been a picture. */
const LONG_MESSAGE_BYTES = 384;

/** What a page does with what its viewer draws. */
export interface Audience {
  /** Whether somebody looks for something in the picture: what stands today is then seen through the square. */
  readonly aligning: boolean;
  /** Whether the picture is to stay: others pass by undrawn. */
  readonly holds: boolean;
  /** The rig need not wait for this picture any longer: it was drawn, or left out. */
  done(frameId: number): void;
  /** A picture was drawn just now. */
  drawn(frame: FrameMessage, now_ms: number): void;
  /** The browser has the page again. */
  back(longAway: boolean): void;
}

interface Waiting {
  readonly message: FrameMessage;
  readonly picture: Picture;
  readonly arrived_ms: number;
  /** What is laid over it, where that is drawn already. */
  readonly overlay: Overlay | null;
}

export class Viewer {
  readonly composite: Composite;
  readonly look: Look;
  /** How old the pose of the drawn picture is. */
  readonly age = new PoseAge();
  readonly overlays = new Overlays();
  frame: FrameMessage | null = null;
  overlay: Overlay = NOTHING;
  square: Square | null = null;
  model: Situation["model"] = "loading";
  framesDrawn = 0;
  posesDrawn = 0;
  mismatched = 0;
  lastPicture_ms: number | null = null;
  drawingLost = false;
  private garbled_ms = Number.NEGATIVE_INFINITY;
  private waiting: Waiting | null = null;
  private newest: { bytes: ArrayBuffer; arrived_ms: number } | null = null;
  private decoding = false;
  /** Whether nothing was drawn since the screen was. */
  private isFree = false;
  private readonly decoder = new Decoder();
  private shown: Picture | null = null;

  constructor(
    canvas: HTMLCanvasElement,
    asked: URLSearchParams,
    private readonly audience: Audience,
  ) {
    this.composite = new Composite(canvas);
    this.look = new Look(this.composite, asked);
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
        this.audience.back(longAway);
      },
    });
    document.body.classList.toggle("frugal", this.composite.drawsInSoftware);
  }

  /** Load a site's square and draw it from then on; resolves at its first paint. */
  async show(site: Site): Promise<void> {
    try {
      this.overlays.eyeHeight_m = site.eye_height_m;
      void this.learnEdges(site);
      const levels = site.models["roman"];
      if (!levels) throw new Error("no model named roman");
      const square = await Square.load(levels, GROUND_SHARE);
      for (const { id, defaultVariant } of site.monuments)
        if (defaultVariant !== null) square.showVariant(id, defaultVariant);
      this.square = square;
      this.look.show(square, site.origin);
      this.composite.show(square);
      this.model = "shown";
      if (site.occluders !== null)
        void loadOccluders(site.occluders).then((group) => square.hideBehind(group), notHidden);
    } catch (error) {
      this.model = "failed";
      throw error;
    }
  }

  private async learnEdges(site: Site): Promise<void> {
    try {
      if (site.walkable !== null) this.overlays.edges = await loadEdges(site.walkable);
    } catch (error) {
      console.warn("the overlay does not know where the site has drops and steps", error);
    }
  }

  /** Take a frame message; it is drawn as soon as it is decoded, unless a newer one has come. */
  take(bytes: ArrayBuffer): void {
    const older = this.newest;
    this.newest = { bytes, arrived_ms: performance.now() };
    if (older) this.leaveOut(older.bytes);
    void this.decode();
  }

  /** Leave out what cannot be read; the rig must not wait for it, if it was a picture. */
  garbled(bytes: ArrayBuffer): void {
    if (bytes.byteLength <= LONG_MESSAGE_BYTES) return;
    this.garbled_ms = performance.now();
    this.leaveOut(bytes);
  }

  /** Whether what came of late could not be read. */
  isGarbled(now_ms: number): boolean {
    return now_ms - this.garbled_ms < GARBLED_FOR_MS;
  }

  /** Something other than a picture could not be read. */
  noteGarbled(): void {
    this.garbled_ms = performance.now();
  }

  /** To be called each time that the screen is drawn. */
  turn(now_ms: number): void {
    this.drawWaiting(now_ms);
    this.isFree = true;
  }

  get pose(): CameraPose | null {
    return this.frame?.pose ?? null;
  }

  /** The pose of the picture that is drawn now, never that of another one. */
  get locked(): CameraPose | null {
    return this.pose?.frameId === this.frame?.frameId ? this.pose : null;
  }

  /** Where the eye of the picture that is drawn now is; null where nobody knows where it looks. */
  get standpoint(): Standpoint | null {
    const { frame, locked } = this;
    if (!frame || !locked?.headingKnown) return null;
    const [e_m, n_m, u_m] = transform(locked.T_site_cam, [0, 0, 0]);
    return { e_m, n_m, u_m, heading_rad: headingOf(locked.T_site_cam), half_rad: fieldOf(frame) / 2 };
  }

  /** Return the pixel of the drawn picture in which a point of the site is; null where it is in none. */
  project(point_site_m: Vector3): readonly [number, number] | null {
    const { frame, locked } = this;
    return frame && locked ? project(frame.lens, transform(invertRigid(locked.T_site_cam), point_site_m)) : null;
  }

  /** Show this share of the past, 0 to 1. */
  setPast(share: number): void {
    this.composite.past = Math.min(1, Math.max(0, share));
    this.composite.redraw();
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
        const decoded = this.decoder.decode(message.jpeg);
        const overlay = this.drawAhead(message);
        const picture = await decoded;
        if (this.waiting) {
          this.audience.done(this.waiting.message.frameId);
          this.waiting.picture.close();
        }
        this.waiting = { message, picture, arrived_ms, overlay };
        // at once, but one for each time that the screen is drawn: more would only queue up
        if (this.isFree || overlay) this.drawWaiting(performance.now());
        this.isFree = false;
      } catch (error) {
        // a picture that does not decode is as good as drawn: else the rig would wait for it
        if (error instanceof WireError && error.frameId !== null) this.audience.done(error.frameId);
        else this.leaveOut(bytes);
        this.garbled_ms = performance.now();
        console.warn("a picture was left out", error);
      }
    }
    this.decoding = false;
  }

  private leaveOut(bytes: ArrayBuffer): void {
    if (bytes.byteLength >= 12) this.audience.done(new DataView(bytes).getUint32(8, true));
  }

  private drawWaiting(now_ms: number): void {
    const next = this.waiting;
    if (!next) return;
    this.waiting = null;
    if (!this.audience.holds && !this.drawingLost) {
      this.draw(next, now_ms);
      return;
    }
    this.audience.done(next.message.frameId);
    next.picture.close();
    this.lastPicture_ms = now_ms;
  }

  /** Draw the model for a picture while that is decoded, if it will be drawn next; return what is laid over it then. */
  private drawAhead(message: FrameMessage): Overlay | null {
    if (!this.isFree || this.waiting || this.audience.holds || this.drawingLost) return null;
    const overlay = this.overlayOf(message);
    this.composite.drawAhead({ lens: message.lens, T_site_cam: overlay.T_site_cam, doubt: overlay.doubt });
    return overlay;
  }

  private overlayOf(message: FrameMessage): Overlay {
    const { pose } = message;
    this.overlays.aligning = this.audience.aligning;
    return this.overlays.take(message, pose?.frameId === message.frameId ? pose : null);
  }

  private draw({ message, picture, arrived_ms, overlay }: Waiting, now_ms: number): void {
    this.frame = message;
    const { pose, locked } = this;
    this.overlay = overlay ?? this.overlayOf(message);
    this.composite.laying = this.overlays.aligning ? seenThrough(this.overlay.laying) : this.overlay.laying;
    this.look.before(message, picture, now_ms);
    const began_ms = performance.now();
    this.composite.draw({
      picture,
      lens: message.lens,
      quarterTurns: message.quarterTurns,
      T_site_cam: this.overlay.T_site_cam,
      doubt: this.overlay.doubt,
    });
    this.look.after(began_ms, arrived_ms);
    this.shown?.close();
    this.shown = picture;
    document.body.classList.remove("empty");
    this.framesDrawn += 1;
    if (locked) this.posesDrawn += 1;
    else if (pose) this.mismatched += 1;
    this.lastPicture_ms = now_ms;
    this.age.drawn(message.t_sent_ns, arrived_ms);
    this.audience.drawn(message, now_ms);
    this.audience.done(message.frameId);
  }
}

function notHidden(error: unknown): void {
  console.warn("nothing hides the square", error);
}

/** Return how wide a picture is, radians, distortion aside. */
export function fieldOf({ lens }: FrameMessage): number {
  return 2 * Math.atan(lens.width_px / (2 * lens.fx_px));
}
