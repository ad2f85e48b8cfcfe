/** The sheets of the tools: at most one is open, and Escape closes it. DOM only. */

import { element } from "../dom";

export class Sheets {
  private readonly openers = document.querySelectorAll<HTMLButtonElement>("[data-opens]");

  /** `opened` is told which sheet comes up. */
  constructor(private readonly opened: (id: string) => void) {
    for (const button of this.openers) {
      button.setAttribute("aria-expanded", "false");
      button.setAttribute("aria-controls", button.dataset["opens"] ?? "");
      button.onclick = () => this.toggle(button.dataset["opens"] ?? "");
    }
    for (const button of document.querySelectorAll<HTMLButtonElement>("[data-closes]"))
      button.onclick = () => this.close();
  }

  toggle(id: string): void {
    const opens = element(id, HTMLElement).hidden;
    this.close();
    if (opens) this.open(id);
  }

  /** Close what is open, and give the focus back; returns whether anything was. */
  close(): boolean {
    let closed = false;
    for (const button of this.openers) {
      const sheet = element(button.dataset["opens"] ?? "", HTMLElement);
      if (sheet.hidden) continue;
      if (sheet.contains(document.activeElement)) button.focus();
      sheet.hidden = true;
      button.setAttribute("aria-expanded", "false");
      closed = true;
    }
    return closed;
  }

  private open(id: string): void {
    const sheet = element(id, HTMLElement);
    sheet.hidden = false;
    for (const button of this.openers) button.setAttribute("aria-expanded", String(button.dataset["opens"] === id));
    sheet.querySelector<HTMLElement>("button, input, a")?.focus();
    this.opened(id);
  }
}
