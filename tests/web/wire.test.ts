/** The binary messages: the golden bytes that Python reads too, and bytes that mean harm. */

import type { LensModel } from "../../web/src/lens";
import {
  decodeFrame,
  decodePose,
  FRAME_HEADER_BYTES,
  magicOf,
  POSE_BYTES,
  symmetric,
  WireError,
  type WireFault,
} from "../../web/src/wire";
import golden from "../golden/wire.json";
import { forSeeds } from "./random";

const frames = golden.messages.flatMap(({ hex, fields }) => (fields.kind === "frame" ? [{ hex, fields }] : []));
const poses = golden.messages.flatMap(({ hex, fields }) => (fields.kind === "pose" ? [{ hex, fields }] : []));

function bytesOf(hex: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(hex.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));
}

function hexOf(bytes: Uint8Array): string {
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

function firstOf<T>(values: readonly T[]): T {
  const [value] = values;
  if (value === undefined) throw new Error("the golden file has none");
  return value;
}

const frameBytes = (): Uint8Array<ArrayBuffer> => bytesOf(firstOf(frames).hex);
const poseBytes = (): Uint8Array<ArrayBuffer> => bytesOf(firstOf(poses).hex);

/** Run `decode`; return its error, which must be a `WireError`, or null. */
function faultOf(decode: () => unknown): WireError | null {
  try {
    decode();
    return null;
  } catch (error) {
    expect(error).toBeInstanceOf(WireError);
    return error as WireError;
  }
}

test("the golden file has frames and poses", () => {
  expect(frames.length).toBeGreaterThanOrEqual(2);
  expect(poses.length).toBeGreaterThanOrEqual(1);
});

test.each(frames)("golden frame $fields.frame_id reads as its fields say", ({ hex, fields }) => {
  const message = decodeFrame(bytesOf(hex).buffer);
  const flags = fields.flags;
  expect(message.frameId).toBe(fields.frame_id);
  expect(message.t_capture_ns).toBe(Number(fields.t_capture_ns));
  expect(message.t_sent_ns).toBe(Number(fields.t_sent_ns));
  expect(message.quarterTurns).toBe(fields.quarter_turns);
  expect(message.soughtJustBefore).toBe((flags & 8) !== 0);
  expect(message.position_s).toBe(fields.position_s);
  expect(hexOf(message.jpeg)).toBe(fields.jpeg_hex);
  const [fx_px, fy_px, cx_px, cy_px] = fields.intrinsics ?? [];
  const distortion = fields.distortion ?? [];
  const model = distortion.length > 0 ? (fields.distortion_model as LensModel) : "none";
  const coefficients = [...distortion, ...new Array<number>(8 - distortion.length).fill(0)];
  const { width: width_px, height: height_px } = fields;
  expect(message.lens).toEqual({ width_px, height_px, fx_px, fy_px, cx_px, cy_px, model, coefficients });
  if ((flags & 1) === 0) {
    expect(message.pose).toBeNull();
    return;
  }
  expect(message.pose).toEqual({
    frameId: fields.pose_frame_id,
    t_ns: Number(fields.t_capture_ns),
    T_site_cam: fields.T_site_cam,
    covariance: symmetric(fields.cov_upper ?? []),
    v_site_m_s: fields.velocity,
    headingKnown: (flags & 2) !== 0,
    isTruth: (flags & 4) !== 0,
    motionModel: fields.motion_model === "-" ? null : fields.motion_model,
    estimator: fields.estimator,
  });
});

test.each(poses)("golden pose $fields.seq reads as its fields say", ({ hex, fields }) => {
  expect(decodePose(bytesOf(hex).buffer)).toEqual({
    seq: fields.seq,
    t_ns: Number(fields.t_ns),
    p_site_body_m: fields.p_site_body,
    wxyz_site_body: fields.wxyz_site_body,
    variance: fields.variance,
    v_site_m_s: fields.velocity,
    headingKnown: (fields.flags & 2) !== 0,
    isTruth: (fields.flags & 4) !== 0,
    soughtJustBefore: (fields.flags & 8) !== 0,
    motionModel: fields.motion_model,
  });
});

test("random bytes of any length are refused", () => {
  forSeeds(300, (random) => {
    const { buffer } = random.bytes(random.below(700));
    expect(faultOf(() => decodeFrame(buffer))).not.toBeNull();
    expect(faultOf(() => decodePose(buffer))).not.toBeNull();
  });
});

test("random bytes behind an honest start are read or refused, and what is read is sound", () => {
  forSeeds(600, (random) => {
    const bytes = random.bytes(random.below(700));
    const honest = random.below(2) === 0 ? frameBytes() : poseBytes();
    bytes.set(honest.subarray(0, Math.min(bytes.length, 4 + random.below(400))));
    faultOf(() => expectSound(decodeFrame(bytes.buffer)));
    faultOf(() => decodePose(bytes.buffer));
  });
});

test("a golden message with a few bytes changed is read or refused, and what is read is sound", () => {
  forSeeds(1500, (random) => {
    const bytes = frameBytes();
    for (let i = 0; i <= random.below(4); i++) bytes[random.below(bytes.length)] = random.below(256);
    faultOf(() => expectSound(decodeFrame(bytes.buffer)));
    const pose = poseBytes();
    for (let i = 0; i <= random.below(4); i++) pose[random.below(pose.length)] = random.below(256);
    faultOf(() => {
      const { p_site_body_m, wxyz_site_body, variance, v_site_m_s } = decodePose(pose.buffer);
      expect([...p_site_body_m, ...wxyz_site_body, ...variance, ...v_site_m_s].every(Number.isFinite)).toBe(true);
      expect(Math.hypot(...wxyz_site_body)).toBeCloseTo(1, 2);
    });
  });
});

function expectSound({ lens, pose, jpeg, position_s, quarterTurns }: ReturnType<typeof decodeFrame>): void {
  const numbers = [lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px, ...lens.coefficients, position_s];
  const ofPose = pose === null ? [] : [...pose.T_site_cam, ...pose.covariance, ...pose.v_site_m_s];
  expect([...numbers, ...ofPose].every(Number.isFinite)).toBe(true);
  expect(Math.min(lens.width_px, lens.height_px)).toBeGreaterThan(0);
  expect([0, 1, 2, 3]).toContain(quarterTurns);
  expect([...jpeg.subarray(0, 2)]).toEqual([0xff, 0xd8]);
}

test("a message cut short at any length is refused", () => {
  const frame = frameBytes();
  for (let length = 0; length < FRAME_HEADER_BYTES + 2; length++)
    expect(faultOf(() => decodeFrame(frame.slice(0, length).buffer))).not.toBeNull();
  const pose = poseBytes();
  for (let length = 0; length < POSE_BYTES; length++)
    expect(faultOf(() => decodePose(pose.slice(0, length).buffer))?.fault).toBe("length");
  expect(faultOf(() => decodePose(new Uint8Array([...pose, 0]).buffer))?.fault).toBe("length");
});

test.each<[string, number, readonly number[], WireFault]>([
  ["another version's magic", 3, [0x32], "magic"],
  ["another header length", 4, [0], "header"],
  ["four quarter turns", 298, [4], "frame"],
  ["no JPEG", FRAME_HEADER_BYTES, [0x89], "jpeg"],
  ["a position that is no number", 344, [0, 0, 0, 0, 0, 0, 0xf8, 0x7f], "frame"],
  ["a picture without width", 292, [0, 0], "size"],
  ["a picture of 65535 pixels", 294, [0xff, 0xff], "size"],
  ["an unknown lens model", 296, [4], "lens"],
  ["a focal length of zero", 244, [0, 0, 0, 0], "lens"],
  ["a coefficient that is infinite", 260, [0, 0, 0x80, 0x7f], "lens"],
  ["a rotation that stretches", 32, [0, 0, 0, 0, 0, 0, 8, 0x40], "pose"],
  ["a place that is no number", 56, [0, 0, 0, 0, 0, 0, 0xf8, 0x7f], "pose"],
  ["a covariance that is infinite", 160, [0, 0, 0x80, 0x7f], "pose"],
  ["a velocity that is no number", 332, [0, 0, 0xc0, 0x7f], "pose"],
  ["an unknown motion model", 297, [9], "pose"],
])("a frame with %s is refused by name, with its id for the acknowledgement", (_what, offset, patch, fault) => {
  const bytes = frameBytes();
  bytes.set(patch, offset);
  const error = faultOf(() => decodeFrame(bytes.buffer));
  expect(error?.fault).toBe(fault);
  expect(error?.frameId).toBe(fault === "magic" ? null : firstOf(frames).fields.frame_id);
});

test("the pose of another picture is told apart, not refused: the page counts it and draws no model", () => {
  const bytes = frameBytes();
  bytes.set([7, 0, 0, 0], 12);
  const { frameId, pose } = decodeFrame(bytes.buffer);
  expect(pose?.frameId).toBe(7);
  expect(frameId).not.toBe(7);
});

test("an estimator's name that is no UTF-8 is shown with a mark in it", () => {
  const bytes = frameBytes();
  bytes.set([0xff], 300);
  expect(decodeFrame(bytes.buffer).pose?.estimator).toMatch(/^\ufffd/);
});

test("the magic of anything shorter than four bytes is empty", () => {
  expect(magicOf(new ArrayBuffer(3))).toBe("");
  expect(magicOf(frameBytes().buffer)).toBe("AGF1");
  expect(magicOf(poseBytes().buffer)).toBe("AGP1");
});

test("a triangle becomes a symmetric matrix that holds it in order", () => {
  const triangle = Array.from({ length: 21 }, (_, i) => i + 1);
  const full = symmetric(triangle);
  const upper: number[] = [];
  for (let row = 0; row < 6; row++) {
    for (let column = 0; column < 6; column++) {
      expect(full[6 * row + column]).toBe(full[6 * column + row]);
      if (column >= row) upper.push(full[6 * row + column] ?? 0);
    }
  }
  expect(upper).toEqual(triangle);
});
