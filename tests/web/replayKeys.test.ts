import type { Playback } from "../../web/src/protocol";
import { deedOfKey, indexAt, pictureAfter, pictureBefore } from "../../web/src/replay/keys";

const PLAYBACK: Playback = { playing: true, position_s: 20, speed: 1, looping: false };

function asked(key: string, changes: Partial<Playback> = {}, shift = false): unknown {
  return deedOfKey(key, shift, { ...PLAYBACK, ...changes }, 60);
}

describe("keys", () => {
  test("each does what the help says", () => {
    expect(asked(" ")).toEqual({ action: "pause", value: null });
    expect(asked(" ", { playing: false })).toEqual({ action: "play", value: null });
    expect(asked("ArrowRight")).toEqual({ action: "seek", value: 25 });
    expect(asked("ArrowLeft", {}, true)).toEqual({ action: "seek", value: 5 });
    expect(asked(".")).toEqual({ action: "step", direction: 1 });
    expect(asked(",")).toEqual({ action: "step", direction: -1 });
    expect(asked("]")).toEqual({ action: "speed", value: 2 });
    expect(asked("[")).toEqual({ action: "speed", value: 0.5 });
    expect(asked("l")).toEqual({ action: "loop", value: true });
    expect(asked("L", { looping: true })).toEqual({ action: "loop", value: false });
    expect(asked("Home")).toEqual({ action: "seek", value: 0 });
    expect(asked("End")).toEqual({ action: "seek", value: 60 });
    expect(asked("?")).toEqual({ action: "help" });
    expect(asked("q")).toBeNull();
  });

  test("a jump ends where the walk does", () => {
    expect(asked("ArrowLeft", { position_s: 2 })).toEqual({ action: "seek", value: 0 });
    expect(asked("ArrowRight", { position_s: 58 })).toEqual({ action: "seek", value: 60 });
  });
});

describe("pictures", () => {
  const TIMES = [0.1, 0.2, 0.3, 0.7];

  test("the newest at a place is found", () => {
    expect([0, 0.1, 0.25, 0.3, 9].map((t) => indexAt(TIMES, t))).toEqual([-1, 0, 1, 2, 3]);
    expect(indexAt([], 1)).toBe(-1);
  });

  test("a step goes to the next and to the one before, and no further than there are any", () => {
    expect(pictureAfter(TIMES, 0.3)).toBe(0.7);
    expect(pictureBefore(TIMES, 0.3)).toBe(0.2);
    expect(pictureAfter(TIMES, 0)).toBe(0.1);
    expect(pictureBefore(TIMES, 0.1)).toBeNull();
    expect(pictureAfter(TIMES, 0.7)).toBeNull();
  });

  test("there and back is where one was", () => {
    for (const from of TIMES.slice(0, -1)) {
      const next = pictureAfter(TIMES, from) ?? Number.NaN;
      expect(pictureBefore(TIMES, next)).toBe(from);
    }
  });
});
