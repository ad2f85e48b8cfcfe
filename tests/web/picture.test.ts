/** Where the picture lies in the canvas: from pixels to places of the canvas and back, upright or turned. */

import { pixelAt, placeOf, reachOf } from "../../web/src/picture";
import { forSeeds } from "./random";

const layout = (quarterTurns: number) => ({ width_px: 640, height_px: 480, quarterTurns });

test("a picture as wide as the canvas fills it", () => {
  expect(reachOf(layout(0), 640 / 480)).toEqual([1, 1]);
  expect(reachOf(layout(1), 480 / 640)).toEqual([1, 1]);
});

test.each([
  [0, [0, 0]],
  [1, [1, 0]],
  [2, [1, 1]],
  [3, [0, 1]],
] as const)("turned %d times the first pixel is in its corner", (turns, [across, down]) => {
  const [x, y] = placeOf(layout(turns), turns % 2 ? 0.75 : 4 / 3, [-0.5, -0.5]);
  expect(x).toBeCloseTo(across, 9);
  expect(y).toBeCloseTo(down, 9);
});

test("beside the picture there is none of it", () => {
  expect(pixelAt(layout(0), 2, [0.01, 0.5])).toBeNull();
  expect(pixelAt(layout(0), 2, [0.5, 0.5])).toEqual([319.5, 239.5]);
  expect(pixelAt(layout(0), 1, [0.5, 0.99])).toBeNull();
});

test("there and back", () => {
  forSeeds(20, (random) => {
    const of = layout(random.below(4));
    const aspect = random.between(0.4, 2.5);
    const pixel: [number, number] = [random.between(0, 639), random.between(0, 479)];
    const back = pixelAt(of, aspect, placeOf(of, aspect, pixel)) ?? [Number.NaN, Number.NaN];
    expect(back[0]).toBeCloseTo(pixel[0], 6);
    expect(back[1]).toBeCloseTo(pixel[1], 6);
  });
});
