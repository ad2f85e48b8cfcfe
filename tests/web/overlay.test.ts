/** What is laid over a picture: style, and what holds it back, together. */

import { Edges, type Triangle } from "../../web/src/edges";
import { Overlays, seenThrough } from "../../web/src/overlay";
import type { CameraPose, FrameMessage } from "../../web/src/wire";

const GROUND: Triangle[] = [
  [
    [-20, -20, 0.4],
    [20, -20, 0.4],
    [20, 20, 0.4],
  ],
  [
    [-20, -20, 0.4],
    [20, 20, 0.4],
    [-20, 20, 0.4],
  ],
];

function pose(e_m: number, sigma_m: number, more: Partial<CameraPose> = {}): CameraPose {
  const covariance = new Array(36).fill(0);
  covariance[0] = covariance[7] = sigma_m ** 2;
  const T_site_cam = [1, 0, 0, e_m, 0, 0, 1, 0, 0, -1, 0, 2, 0, 0, 0, 1];
  return { t_ns: 0, T_site_cam, covariance, v_site_m_s: [0, 0, 0], headingKnown: true, ...more } as CameraPose;
}
const message = (soughtJustBefore = false): FrameMessage => ({ soughtJustBefore }) as FrameMessage;

function overlays(): Overlays {
  const made = new Overlays();
  made.edges = new Edges(GROUND, []);
  return made;
}

test("a sure pose is drawn as it is, a fair one as a ghost, a poor one not at all", () => {
  expect(overlays().take(message(), pose(0, 0.1))).toMatchObject({
    style: "locked",
    laying: { share: 1, outline: 0, clear_m: 0, eye_m: 1.6 },
    T_site_cam: pose(0, 0.1).T_site_cam,
  });
  const ghost = overlays().take(message(), pose(0, 3));
  expect(ghost.style).toBe("ghost");
  expect(ghost.laying.share).toBeLessThan(0.5);
  expect(ghost.laying.outline).toBeGreaterThan(0.5);
  expect(overlays().take(message(), pose(0, 50))).toMatchObject({ style: "guide", T_site_cam: null });
  expect(overlays().take(message(), null)).toMatchObject({ style: "none", T_site_cam: null });
});

test("near a drop little is left, in every style", () => {
  const { laying, nearEdge } = overlays().take(message(), pose(19, 0.1));
  expect(laying.share).toBeLessThan(0.2);
  expect(nearEdge).toBe(true);
  expect(overlays().take(message(), pose(18, 3)).laying.outline).toBeLessThan(0.2);
});

test("while walking the ground is left clear", () => {
  expect(overlays().take(message(), pose(0, 0.1, { v_site_m_s: [1.2, 0, 0] })).laying.clear_m).toBe(5);
});

test("after a seek the style is that of the new place at once", () => {
  const made = overlays();
  expect(made.take(message(), pose(0, 50)).style).toBe("guide");
  expect(made.take(message(), pose(0, 0.1, { t_ns: 1e8 })).style).toBe("guide");
  expect(made.take(message(true), pose(0, 0.1, { t_ns: 2e8 })).style).toBe("locked");
});

test("off the ground that is known, the eyes are as high as the site says", () => {
  const made = overlays();
  made.eyeHeight_m = 1.7;
  expect(made.take(message(), pose(300, 0.1)).laying.eye_m).toBe(1.7);
});

test("who aligns the square sees it however far off it is, unless nobody knows where it is", () => {
  const made = overlays();
  made.aligning = true;
  expect(made.take(message(), pose(0, 50)).style).toBe("ghost");
  expect(made.take(message(), pose(0, 0.1, { t_ns: 1e8, headingKnown: false })).style).toBe("guide");
});

test("through the square that is being aligned, what stands today is seen", () => {
  const { share, outline } = seenThrough({ share: 1, outline: 0, clear_m: 3, eye_m: 1.6 });
  expect(share).toBeLessThan(0.5);
  expect(outline).toBeGreaterThan(0.5);
  expect(seenThrough({ share: 0, outline: 0, clear_m: 3, eye_m: 1.6 }).outline).toBe(0);
});
