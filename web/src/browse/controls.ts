/** Keys, a stick on the screen, a gamepad and drags on the picture, as one intent and turns of the head. DOM only. */

import { type Intent, moves, ofGamepad, ofKeys, ofStick, STILL, together } from "./intent";
import { isTaken } from "./typing";

/** Turned by a drag across so many pixels by one radian. */
const PX_PER_RAD = 420;

export class Controls {
  /** Called when something is wanted, after nothing was. */
  woken: () => void = () => undefined;
  /** Called with how far the head is turned to the right and upwards by a drag, radians. */
  looked: (turn_rad: number, tilt_rad: number) => void = () => undefined;
  /** Called when the visitor takes hold of the picture. */
  taken: () => void = () => undefined;
  private readonly held = new Set<string>();
  private stick: Intent = STILL;
  private hasGamepad = false;
  private drag: { readonly id: number; x: number; y: number } | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    stick: HTMLElement,
  ) {
    window.addEventListener("keydown", (event) => this.press(event));
    window.addEventListener("keyup", ({ code }) => this.held.delete(code));
    // a key that is let go elsewhere is never heard of
    window.addEventListener("blur", () => this.held.clear());
    window.addEventListener("gamepadconnected", () => {
      this.hasGamepad = true;
      this.woken();
    });
    window.addEventListener("gamepaddisconnected", () => {
      this.hasGamepad = gamepads().length > 0;
    });
    this.listenToDrags();
    this.listenToStick(stick);
  }

  /** What is wanted now. */
  get intent(): Intent {
    const pads = this.hasGamepad ? gamepads() : [];
    return together([
      ofKeys(this.held),
      this.stick,
      ...pads.map(({ axes, buttons }) =>
        ofGamepad(
          axes,
          buttons.map(({ value }) => value),
        ),
      ),
    ]);
  }

  /** Whether something must be looked at again and again: a gamepad tells nothing by itself. */
  get mustWatch(): boolean {
    return this.hasGamepad;
  }

  private press(event: KeyboardEvent): void {
    const { code } = event;
    if (isTaken(event)) return;
    this.held.add(code);
    if (!moves(code)) return;
    event.preventDefault(); // arrows would scroll a panel
    this.woken();
  }

  private listenToDrags(): void {
    const { canvas } = this;
    canvas.addEventListener("pointerdown", (event) => {
      this.taken();
      if (this.drag || event.button !== 0) return;
      this.drag = { id: event.pointerId, x: event.clientX, y: event.clientY };
    });
    window.addEventListener("pointermove", ({ pointerId, clientX, clientY }) => {
      const { drag } = this;
      if (drag?.id !== pointerId) return;
      // the picture follows the finger
      this.looked((drag.x - clientX) / PX_PER_RAD, (clientY - drag.y) / PX_PER_RAD);
      [drag.x, drag.y] = [clientX, clientY];
    });
    const end = ({ pointerId }: PointerEvent): void => {
      if (this.drag?.id === pointerId) this.drag = null;
    };
    window.addEventListener("pointerup", end);
    window.addEventListener("pointercancel", end);
  }

  private listenToStick(stick: HTMLElement): void {
    const knob = stick.firstElementChild as HTMLElement;
    const put = (right: number, ahead: number): void => {
      this.stick = ofStick(right, ahead);
      knob.style.translate = `${34 * right}px ${-34 * ahead}px`;
      this.woken();
    };
    const follow = (event: PointerEvent): void => {
      const { left, top, width, height } = stick.getBoundingClientRect();
      const [x, y] = [(event.clientX - left) / width - 0.5, (event.clientY - top) / height - 0.5];
      const far = Math.max(1, 2 * Math.hypot(x, y));
      put((2 * x) / far, (-2 * y) / far);
    };
    stick.addEventListener("pointerdown", (event) => {
      stick.setPointerCapture(event.pointerId);
      this.taken();
      follow(event);
    });
    stick.addEventListener("pointermove", (event) => {
      if (stick.hasPointerCapture(event.pointerId)) follow(event);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const)
      stick.addEventListener(end, () => put(0, 0));
  }
}

function gamepads(): Gamepad[] {
  return navigator.getGamepads().filter((pad): pad is Gamepad => pad?.connected === true);
}
