/** One walk that is watched from beside: its connection, its poses, and who else watches. No DOM, no three.js. */

import type { Eye } from "../browse/eye";
import type { Lens } from "../lens";
import type { Companion } from "../messages.gen";
import { parseState, type Session } from "../protocol";
import { Link } from "../socket";
import { decodeFrame, decodePose, magicOf, type PoseMessage } from "../wire";
import type { Connection } from "../words";
import { Poses } from "./poses";

export interface News {
  /** A pose has come. */
  pose(pose: PoseMessage): void;
  /** What a picture was taken through has come. */
  lens(lens: Lens): void;
  /** Who watches, or the session, has changed. */
  company(): void;
}

/** A pose that is older than this when the page looks again is not shown as one who walks now. */
const SILENT_MS = 5000;
/** A recording tells a pose with each picture, a dozen a second, and nobody waits for it: better late and smooth. */
const RECORDED_DELAY_MS = 130;

export class Walk {
  poses: Poses;
  session: Session;
  connection: Connection = "connecting";
  /** How many watch, this page among them; null before the server has said so. */
  watching: number | null = null;
  /** Those of the others who show where they look from. */
  others: readonly Companion[] = [];
  private number: number | null = null;
  private heard_ms = Number.NEGATIVE_INFINITY;
  private readonly link: Link;

  constructor(
    session: Session,
    private readonly news: News,
  ) {
    this.session = session;
    this.poses = posesOf(session);
    // of the pictures only the first is wanted, without what is on it: for its lens
    const url = new URL(`/ws/view/${encodeURIComponent(session.name)}?pictures=none`, location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.link = new Link(url.href, {
      connection: (state) => {
        this.connection = state;
        this.number = null;
        news.company();
      },
      text: (text) => this.text(text),
      binary: (bytes) => this.binary(bytes),
    });
  }

  get name(): string {
    return this.session.name;
  }

  /** Whether there is a walker to be shown, moving or standing. */
  isHeard(now_ms: number): boolean {
    return now_ms - this.heard_ms < SILENT_MS;
  }

  /** Show the others where this page looks from; null for no longer. */
  look(eye: Eye | null): void {
    this.link.send({ type: "look", eye });
  }

  close(): void {
    this.link.close();
  }

  private text(text: string): void {
    try {
      const message = parseState(text);
      if (message?.type === "session") this.take(message.session, message.number);
      if (message?.type === "company") {
        this.watching = message.watching;
        this.others = message.seen.filter(({ number }) => number !== this.number);
      }
      this.news.company();
    } catch (error) {
      console.warn("a message was left out", error);
    }
  }

  private take(session: Session, number: number | null): void {
    // a replay that has been made faster or slower has another clock
    if (session.playback?.speed !== this.session.playback?.speed) this.poses = posesOf(session);
    this.session = session;
    this.number = number ?? this.number;
  }

  private binary(bytes: ArrayBuffer): void {
    try {
      if (magicOf(bytes) === "AGF1") {
        this.news.lens(decodeFrame(bytes).lens);
        return;
      }
      const pose = decodePose(bytes);
      this.heard_ms = performance.now();
      this.poses.take(pose, this.heard_ms);
      this.news.pose(pose);
    } catch (error) {
      console.warn("a message was left out", error);
    }
  }
}

function posesOf({ playback }: Session): Poses {
  return playback === null ? new Poses() : new Poses(playback.speed, RECORDED_DELAY_MS);
}
