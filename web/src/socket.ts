/** The connection to one session: it comes back by itself, and tells what became of it. */

import { FORBIDDEN, type FromViewer, NO_SESSION, OTHER_VERSION, SUBPROTOCOL } from "./messages.gen";
import type { Connection } from "./words";

export interface Listener {
  binary(bytes: ArrayBuffer): void;
  text(text: string): void;
  connection(state: Connection): void;
}

const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 1500;
const MEANINGS: Readonly<Record<number, Connection>> = {
  [FORBIDDEN]: "refused",
  [NO_SESSION]: "no session",
  [OTHER_VERSION]: "other version",
};

export class Link {
  private socket: WebSocket | null = null;
  private wait_ms = FIRST_WAIT_MS;
  private timer: number | undefined;
  private readonly url: string;
  private readonly listener: Listener;

  constructor(url: string, listener: Listener) {
    this.url = url;
    this.listener = listener;
    this.connect();
  }

  /** Send a JSON message; false where there is no connection. */
  send(message: FromViewer): boolean {
    if (this.socket?.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }

  /** End the connection for good. */
  close(): void {
    window.clearTimeout(this.timer);
    const socket = this.socket;
    this.socket = null;
    socket?.close();
  }

  private connect(): void {
    const socket = new WebSocket(this.url, SUBPROTOCOL);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.wait_ms = FIRST_WAIT_MS;
      this.listener.connection("open");
    };
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.listener.binary(data);
      else if (typeof data === "string") this.listener.text(data);
    };
    socket.onclose = ({ code }) => {
      if (this.socket !== socket) return;
      this.listener.connection(MEANINGS[code] ?? "lost");
      this.timer = window.setTimeout(() => this.connect(), this.wait_ms);
      this.wait_ms = Math.min(2 * this.wait_ms, LONGEST_WAIT_MS);
    };
  }
}
