/** A JPEG's planes: which are shown as they are, where they lie, and what of them is metered. */

import { arePlanes, type Described, planesIn, roomFor, spread } from "../../web/src/planes";

const JPEG: Described = {
  format: "I420",
  codedWidth: 640,
  codedHeight: 480,
  displayWidth: 640,
  displayHeight: 480,
  colorSpace: { fullRange: true, matrix: "smpte170m" },
  rotation: 0,
  flip: false,
};

test("planes are shown where nothing has to be done to them", () => {
  for (const format of ["I420", "I422", "I444"]) expect(arePlanes({ ...JPEG, format })).toBe(true);
  const others: readonly Partial<Described>[] = [
    { format: null },
    { format: "BGRX" },
    { format: "NV12" },
    { format: "I420A" },
    { rotation: 180 },
    { rotation: 90, displayWidth: 480, displayHeight: 640 },
    { flip: true },
    { displayWidth: 320 },
    { colorSpace: { fullRange: false, matrix: "smpte170m" } },
    { colorSpace: { fullRange: true, matrix: "bt709" } },
    { colorSpace: { fullRange: null, matrix: null } },
  ];
  for (const other of others) expect(arePlanes({ ...JPEG, ...other })).toBe(false);
  const { rotation: _, ...untold } = JPEG;
  expect(arePlanes(untold)).toBe(false); // it may lie on its side
});

test.each([
  ["I420", 4, 2, [2, 1]],
  ["I420", 5, 3, [3, 2]],
  ["I422", 5, 3, [3, 3]],
  ["I444", 5, 3, [5, 3]],
] as const)("%s of %i x %i pixels is luma, and chroma by pairs", (format, width, height, [w, h]) => {
  const room = new Uint8Array(roomFor(format, width, height));
  room.fill(10, 0, width * height);
  for (let i = 0; i < w * h; i++) {
    room[width * height + i] = 100 + i;
    room[width * height + w * h + i] = 200 + i;
  }
  const { luma, chroma } = planesIn(room, format, width, height);
  expect([luma.width, luma.height, ...new Set(luma.bytes)]).toEqual([width, height, 10]);
  expect(luma.bytes.length).toBe(width * height);
  expect([chroma.width, chroma.height]).toEqual([w, h]);
  expect([...chroma.bytes]).toEqual(Array.from({ length: w * h }, (_, i) => [100 + i, 200 + i]).flat());
});

test("what is metered are the picture's colours, from all over it", () => {
  const room = new Uint8Array(roomFor("I420", 4, 4));
  // sRGB red, green, blue and white by BT.601, each 2 x 2 pixels
  const [ys, blues, reds] = [
    [76, 150, 29, 255],
    [85, 44, 255, 128],
    [255, 21, 107, 128],
  ] as const;
  for (let i = 0; i < 16; i++) room[i] = ys[2 * (i >> 3) + ((i >> 1) & 1)] ?? 0;
  room.set(blues, 16);
  room.set(reds, 20);
  const rgba = spread(planesIn(room, "I420", 4, 4), 2, 2);
  const pure = [
    [255, 0, 0, 255],
    [0, 255, 0, 255],
    [0, 0, 255, 255],
    [255, 255, 255, 255],
  ].flat();
  expect(rgba.length).toBe(16);
  rgba.forEach((byte, i) => {
    expect(Math.abs(byte - (pure[i] ?? 0))).toBeLessThanOrEqual(2);
  });
});
