/** Where the picture lies in the canvas: all of it is seen, upright, and nothing of it is stretched. Pure. */

import type { Pair } from "./lens";

/** What of a picture decides where it lies. */
export interface Layout {
  readonly width_px: number;
  readonly height_px: number;
  /** Clockwise quarter turns that make it upright. */
  readonly quarterTurns: number;
}

/** Return how far the picture reaches in the canvas, 0 to 1 of its half width and half height. */
export function reachOf({ width_px, height_px, quarterTurns }: Layout, canvasAspect: number): Pair {
  const aspect = quarterTurns % 2 === 0 ? width_px / height_px : height_px / width_px;
  return aspect > canvasAspect ? [1, canvasAspect / aspect] : [aspect / canvasAspect, 1];
}

/** Return the pixel of the stored picture at a place of the canvas (0 to 1 from its top left); null beside the picture. */
export function pixelAt(layout: Layout, canvasAspect: number, [across, down]: Pair): Pair | null {
  const [reachX, reachY] = reachOf(layout, canvasAspect);
  const [x, y] = [(2 * across - 1) / reachX, (1 - 2 * down) / reachY];
  if (Math.abs(x) > 1 || Math.abs(y) > 1) return null;
  const turns: readonly Pair[] = [
    [x, y],
    [-y, x],
    [-x, -y],
    [y, -x],
  ];
  const [px, py] = turns[layout.quarterTurns] ?? [x, y];
  return [((px + 1) / 2) * layout.width_px - 0.5, ((1 - py) / 2) * layout.height_px - 0.5];
}

/** Return the place in the canvas (0 to 1 from its top left) of a pixel of the stored picture. */
export function placeOf(layout: Layout, canvasAspect: number, [u_px, v_px]: Pair): Pair {
  const [reachX, reachY] = reachOf(layout, canvasAspect);
  const [px, py] = [(2 * (u_px + 0.5)) / layout.width_px - 1, 1 - (2 * (v_px + 0.5)) / layout.height_px];
  const turns: readonly Pair[] = [
    [px, py],
    [py, -px],
    [-px, -py],
    [-py, px],
  ];
  const [x, y] = turns[layout.quarterTurns] ?? [px, py];
  return [(x * reachX + 1) / 2, (1 - y * reachY) / 2];
}
