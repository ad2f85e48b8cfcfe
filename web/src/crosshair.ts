/** A mark over a picture for those who point with keys: the arrows move it, Enter points. DOM only. */

import type { Pair } from "./lens";

/** By one press, pixels of the window; with shift, further. */
const STEP_PX = 8;
const LEAP_PX = 48;
const WAYS: Readonly<Record<string, Pair>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

export class Crosshair {
  isOn = false;
  /** In the window; null until it is moved. */
  private at: Pair | null = null;

  /** `point` is told of a point of the window. */
  constructor(
    private readonly target: HTMLElement,
    private readonly mark: HTMLElement,
    private readonly point: (at: Pair) => void,
  ) {
    target.addEventListener("keydown", (event) => this.key(event));
  }

  /** Whether somebody is about to point. */
  get isMoving(): boolean {
    return this.at !== null;
  }

  /** Forget where it was. */
  rest(): void {
    this.at = null;
  }

  private key(event: KeyboardEvent): void {
    if (!this.isOn || event.ctrlKey || event.metaKey || event.altKey) return;
    const way = WAYS[event.key];
    if (way) this.move(way, event.shiftKey ? LEAP_PX : STEP_PX);
    else if (this.at !== null && (event.key === "Enter" || event.key === " ")) this.point(this.at);
    else return;
    // the arrows and the space bar have uses of their own on the page
    event.preventDefault();
    event.stopPropagation();
  }

  private move([right, down]: Pair, by_px: number): void {
    const box = this.target.getBoundingClientRect();
    const [x, y] = this.at ?? [box.left + box.width / 2, box.top + box.height / 2];
    this.at = [
      Math.min(Math.max(x + right * by_px, box.left), box.right),
      Math.min(Math.max(y + down * by_px, box.top), box.bottom),
    ];
    this.mark.style.left = `${this.at[0]}px`;
    this.mark.style.top = `${this.at[1]}px`;
    this.mark.hidden = false;
  }
}
