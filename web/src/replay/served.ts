/** A walk that a server plays: pictures and state over its socket, everything else by requests. */

import { languages } from "../language/speech";
import type { Request } from "../playback";
import { parseState } from "../protocol";
import { parseSite, type Site } from "../site";
import { Link } from "../socket";
import { magicOf } from "../wire";
import { type Course, parseCourse, parseTimeline, type Timeline } from "./review";
import type { Listener, Source } from "./source";

export class Served implements Source {
  readonly isServed = true;
  private link: Link | null = null;
  private listener: Listener | null = null;
  private requests = 0;
  /** A jump that the rig is about, and where to go after it: of many places that a finger passes the newest is enough. */
  private jump: string | null = null;
  private next: Request | null = null;

  constructor(readonly name: string) {}

  start(listener: Listener): void {
    this.listener = listener;
    const url = new URL(`/ws/view/${encodeURIComponent(this.name)}${location.search}`, location.href);
    url.protocol = url.protocol.replace("http", "ws");
    this.link = new Link(url.href, {
      connection: (state) => {
        [this.jump, this.next] = [null, null];
        listener.connection(state);
      },
      text: (text) => this.text(text, listener),
      binary: (bytes) => (magicOf(bytes) === "AGF1" ? listener.picture(bytes) : listener.garbled(bytes)),
    });
  }

  ask(request: Request): void {
    if (request.action === "seek" && this.jump !== null) {
      this.next = request;
      return;
    }
    this.requests += 1;
    const name = `r${this.requests}`;
    if (!this.link?.send({ type: "control", request_id: name, ...request })) this.listener?.refused(null);
    else if (request.action === "seek") this.jump = name;
  }

  done(frameId: number): void {
    this.link?.send({ type: "ack", frame_id: frameId });
  }

  async site(): Promise<Site> {
    return parseSite(await (await fetch("/api/site")).json(), languages(navigator.languages));
  }

  async timeline(): Promise<Timeline> {
    return parseTimeline(await (await this.get("timeline")).json());
  }

  async thumbnails(): Promise<ImageBitmap | null> {
    const answer = await fetch(this.address("thumbnails"));
    return answer.ok ? createImageBitmap(await answer.blob()) : null;
  }

  async course(estimator: string): Promise<Course> {
    return parseCourse(await (await this.get(`course?estimator=${encodeURIComponent(estimator)}`)).json());
  }

  private address(what: string): string {
    return `/api/replays/${encodeURIComponent(this.name)}/${what}`;
  }

  private async get(what: string): Promise<Response> {
    const answer = await fetch(this.address(what));
    if (answer.ok) return answer;
    throw new Error(await detailOf(answer));
  }

  private text(text: string, listener: Listener): void {
    try {
      const message = parseState(text);
      if (message?.type === "session") listener.session(message.session);
      if (message?.type !== "reply") return;
      if (!message.reply.ok) listener.refused(message.reply.error);
      if (message.reply.requestId === this.jump) this.jumped();
    } catch (error) {
      listener.garbled(null);
      console.warn("a message was left out", error);
    }
  }

  private jumped(): void {
    const { next } = this;
    [this.jump, this.next] = [null, null];
    if (next) this.ask(next);
  }
}

/** Return the sentence in which a server refuses something; empty where it gives none. */
export async function detailOf(answer: Response): Promise<string> {
  try {
    const { detail } = (await answer.json()) as { detail?: unknown };
    return typeof detail === "string" ? detail : "";
  } catch {
    return "";
  }
}
