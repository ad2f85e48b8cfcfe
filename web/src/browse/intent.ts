/** What a visitor wants to do, whether by keys, by a stick on the screen or by a gamepad: one value of it. Pure. */

/** Each from -1 to 1. */
export interface Intent {
  readonly ahead: number;
  readonly right: number;
  readonly up: number;
  /** To the right. */
  readonly turn: number;
  /** Upwards. */
  readonly tilt: number;
  readonly hurry: boolean;
}

export const STILL: Intent = { ahead: 0, right: 0, up: 0, turn: 0, tilt: 0, hurry: false };

type Axis = Exclude<keyof Intent, "hurry">;

/** Keys by where they are on the keyboard, whatever is written on them. */
const KEYS: Readonly<Record<string, readonly [Axis, number]>> = {
  KeyW: ["ahead", 1],
  KeyS: ["ahead", -1],
  KeyA: ["right", -1],
  KeyD: ["right", 1],
  ArrowUp: ["ahead", 1],
  ArrowDown: ["ahead", -1],
  ArrowLeft: ["turn", -1],
  ArrowRight: ["turn", 1],
  PageUp: ["tilt", 1],
  PageDown: ["tilt", -1],
  KeyE: ["up", 1],
  KeyQ: ["up", -1],
};
const HURRY = new Set(["ShiftLeft", "ShiftRight"]);
/** A stick that is let go does not quite come back to its middle. */
const DEAD = 0.15;

/** Whether a key moves. */
export function moves(code: string): boolean {
  return code in KEYS;
}

/** Return what the keys that are held down want. */
export function ofKeys(held: ReadonlySet<string>): Intent {
  const wish: Record<Axis, number> = { ahead: 0, right: 0, up: 0, turn: 0, tilt: 0 };
  for (const code of held) {
    const key = KEYS[code];
    if (key) wish[key[0]] += key[1];
  }
  return together([{ ...wish, hurry: [...held].some((code) => HURRY.has(code)) }]);
}

/** Return what a stick wants that is pushed to the right and ahead, each -1 to 1: at its rim it hurries. */
export function ofStick(right: number, ahead: number): Intent {
  const [x, y] = alive(right, ahead);
  return { ...STILL, right: x, ahead: y, hurry: Math.hypot(x, y) > 0.97 };
}

/** Return what a gamepad of the standard layout wants: left stick moves, right stick looks, triggers go down and up. */
export function ofGamepad(axes: readonly number[], pressed: readonly number[]): Intent {
  const at = (values: readonly number[], index: number): number => {
    const value = values[index] ?? 0;
    return Number.isFinite(value) ? value : 0;
  };
  const [right, ahead] = alive(at(axes, 0), -at(axes, 1));
  const [turn, tilt] = alive(at(axes, 2), -at(axes, 3));
  const up = at(pressed, 7) - at(pressed, 6);
  return together([{ right, ahead, turn, tilt, up, hurry: at(pressed, 10) > 0.5 || at(pressed, 0) > 0.5 }]);
}

/** Return what several of them want together. */
export function together(intents: readonly Intent[]): Intent {
  const sum = (axis: Axis): number =>
    Math.min(
      1,
      Math.max(
        -1,
        intents.reduce((total, intent) => total + intent[axis], 0),
      ),
    );
  return {
    ahead: sum("ahead"),
    right: sum("right"),
    up: sum("up"),
    turn: sum("turn"),
    tilt: sum("tilt"),
    hurry: intents.some(({ hurry }) => hurry),
  };
}

export function isStill({ ahead, right, up, turn, tilt }: Intent): boolean {
  return ahead === 0 && right === 0 && up === 0 && turn === 0 && tilt === 0;
}

/** Return a stick's place without its dead middle, in the unit circle. */
function alive(x: number, y: number): readonly [number, number] {
  const length = Math.hypot(x, y);
  if (!(length > DEAD)) return [0, 0];
  const wanted = Math.min(1, (length - DEAD) / (1 - DEAD));
  return [(x / length) * wanted, (y / length) * wanted];
}
