/** The walk as one file to take away: asked of the server, which packs it, and saved. DOM and requests. */

import { element, tell } from "../dom";
import { say } from "../language/speech";
import { detailOf } from "./served";

export class Taking {
  private readonly sheet = element("taking", HTMLDialogElement);
  private readonly pictures = element("taking-pictures", HTMLInputElement);
  private readonly words = element("taking-words", HTMLElement);
  private readonly take = element("taking-take", HTMLButtonElement);

  constructor(private readonly name: string) {
    element("taking-open", HTMLButtonElement).onclick = () => {
      tell(this.words, null);
      this.sheet.showModal();
    };
    element("taking-close", HTMLButtonElement).onclick = () => this.sheet.close();
    this.take.onclick = () => void this.fetch();
  }

  private async fetch(): Promise<void> {
    this.take.disabled = true;
    tell(this.words, say("replay.taking.packing"));
    try {
      const query = `pictures=${this.pictures.checked}`;
      const answer = await fetch(`/api/replays/${encodeURIComponent(this.name)}/page?${query}`);
      if (answer.ok) {
        save(await answer.blob(), `${this.name}.html`);
        this.sheet.close();
      } else tell(this.words, (await detailOf(answer)) || say("replay.taking.failed"));
    } catch {
      tell(this.words, say("replay.taking.failed"));
    }
    this.take.disabled = false;
  }
}

function save(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
