/** A recording dropped on the page, or chosen: brought to the server, and its replay opened. DOM and requests. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import { detailOf } from "./served";
import { nameOf, otherName, refusalOf } from "./upload";

const MOST_NAMES = 20;

class Refused extends Error {
  constructor(
    readonly status: number,
    detail: string,
  ) {
    super(detail);
  }
}

export class Drop {
  private readonly veil = element("drop", HTMLElement);
  private readonly words = element("drop-words", HTMLElement);
  private readonly bar = element("drop-bar", HTMLProgressElement);
  private readonly close = element("drop-close", HTMLButtonElement);
  private readonly file = element("drop-file", HTMLInputElement);
  private busy = false;

  constructor() {
    // a drag goes over one element of the page after another
    let over = 0;
    window.addEventListener("dragenter", (event) => {
      if (!hasFiles(event)) return;
      over += 1;
      if (!this.busy) this.say(say("replay.drop.here"));
    });
    window.addEventListener("dragleave", (event) => {
      if (!hasFiles(event)) return;
      over = Math.max(0, over - 1);
      if (over === 0 && !this.busy) this.veil.hidden = true;
    });
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      over = 0;
      const file = event.dataTransfer?.files[0];
      if (file) void this.bring(file);
    });
    this.file.onchange = () => {
      const file = this.file.files?.[0];
      this.file.value = "";
      if (file) void this.bring(file);
    };
    this.close.onclick = () => {
      this.veil.hidden = true;
    };
    element("open", HTMLButtonElement).onclick = () => this.file.click();
  }

  private async bring(file: File): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    try {
      if (!/\.mcap$/i.test(file.name)) throw new Refused(415, say("replay.drop.no_mcap"));
      const name = await this.upload(file);
      this.say(say("replay.drop.opening"));
      location.assign(`/replay/${encodeURIComponent(await replayOf(name))}`);
    } catch (error) {
      const refused = error instanceof Refused ? error : new Refused(0, "");
      this.say(refusalOf(refused.status, refused.message), null, true);
    }
    this.busy = false;
  }

  /** Send the file under the first name that is free. */
  private async upload(file: File): Promise<string> {
    const own = nameOf(file.name);
    for (let number = 1; ; number++) {
      const name = number === 1 ? own : otherName(own, number);
      try {
        await this.send(file, name);
        return name;
      } catch (error) {
        if (!(error instanceof Refused && error.status === 409 && number < MOST_NAMES)) throw error;
      }
    }
  }

  private send(file: File, name: string): Promise<void> {
    this.say(say("replay.drop.sending", { name: file.name }), 0);
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest(); // unlike fetch it tells how much has gone
      request.upload.onprogress = ({ loaded, total }) => {
        const share = total > 0 ? loaded / total : 0;
        if (share < 1) this.say(say("replay.drop.sending", { name: file.name }), share);
        else this.say(say("replay.drop.reading"));
      };
      request.onload = () => {
        if (request.status === 201) resolve();
        else
          void detailOf(new Response(request.responseText)).then((detail) =>
            reject(new Refused(request.status, detail)),
          );
      };
      request.onerror = () => reject(new Refused(0, ""));
      request.open("PUT", `/api/logs/${encodeURIComponent(name)}`);
      request.send(file);
    });
  }

  /** Say how it stands: `share` of it is done, null for nobody knows. */
  private say(words: string, share: number | null = null, isOver = false): void {
    this.veil.hidden = false;
    tell(this.words, words);
    this.veil.classList.toggle("refused", isOver);
    this.bar.hidden = isOver || (!this.busy && share === null);
    this.close.hidden = !isOver;
    if (isOver) this.close.focus();
    if (share === null) this.bar.removeAttribute("value");
    else this.bar.value = share;
  }
}

/** Begin a replay of a walk and return its session's name. */
async function replayOf(log: string): Promise<string> {
  const headers = { "Content-Type": "application/json" };
  const answer = await fetch("/api/sessions", { method: "POST", headers, body: JSON.stringify({ log }) });
  if (!answer.ok) throw new Refused(answer.status, await detailOf(answer));
  const { name } = (await answer.json()) as { name: string };
  return name;
}

function hasFiles(event: DragEvent): boolean {
  return event.dataTransfer?.types.includes("Files") ?? false;
}
