/**
 * The binary messages, version 1, little endian with fixed offsets: bytes to values, or one `WireError`.
 *
 * The twin of `server/wire.py`; `tests/golden/wire.json` proves that both read the same. Whatever comes in is checked here,
 * so that nothing behind this file ever meets a picture without its size, a pose that is no rotation, or a NaN.
 */

import { isRigid, type Matrix4, type Vector3 } from "./frames";
import type { Lens, LensModel } from "./lens";
import { FRAME_HEADER_BYTES, POSE_BYTES } from "./messages.gen";

export { FRAME_HEADER_BYTES, POSE_BYTES };

/** No picture of a rig comes near this; a larger message is refused unread. */
const LARGEST_MESSAGE_BYTES = 16 * 1024 * 1024;
const LARGEST_SIDE_PX = 8192;

export type WireFault = "length" | "magic" | "header" | "frame" | "size" | "lens" | "pose" | "jpeg";

/** Bytes that are not what they claim to be. `frameId` is there where it could be read, for the acknowledgement. */
export class WireError extends Error {
  readonly fault: WireFault;
  readonly frameId: number | null;

  constructor(fault: WireFault, message: string, frameId: number | null = null) {
    super(message);
    this.name = "WireError";
    this.fault = fault;
    this.frameId = frameId;
  }
}

/** Where the camera of one picture stood and looked. */
export interface CameraPose {
  /** The picture that this pose belongs to. */
  readonly frameId: number;
  /** When that picture was taken, on the rig's clock; exact to 256 ns where that clock counts from 1970. */
  readonly t_ns: number;
  readonly T_site_cam: Matrix4;
  /** 36 numbers, row major: position (m²) then rotation vector (rad²), site axes. */
  readonly covariance: readonly number[];
  readonly v_site_m_s: Vector3;
  readonly headingKnown: boolean;
  readonly isTruth: boolean;
  /** `P0R0` … `P2R2`, or null where the estimator has none. */
  readonly motionModel: string | null;
  readonly estimator: string;
}

export interface FrameMessage {
  readonly frameId: number;
  readonly t_capture_ns: number;
  readonly t_sent_ns: number;
  readonly lens: Lens;
  /** Clockwise quarter turns that make the stored picture upright. */
  readonly quarterTurns: number;
  readonly soughtJustBefore: boolean;
  /** Null until the estimator has one. */
  readonly pose: CameraPose | null;
  readonly position_s: number;
  readonly jpeg: Uint8Array<ArrayBuffer>;
}

export interface PoseMessage {
  readonly seq: number;
  readonly t_ns: number;
  readonly p_site_body_m: Vector3;
  readonly wxyz_site_body: readonly [number, number, number, number];
  readonly variance: readonly number[];
  readonly v_site_m_s: Vector3;
  readonly headingKnown: boolean;
  readonly isTruth: boolean;
  readonly soughtJustBefore: boolean;
  readonly motionModel: string | null;
}

const LENS_MODELS: readonly LensModel[] = ["none", "plumb_bob", "rational_polynomial", "equidistant"];
const POSE_VALID = 1;
const HEADING_KNOWN = 2;
const IS_TRUTH = 4;
const SOUGHT = 8;

/** Return the first four bytes as text: "AGF1" for a frame, "AGP1" for a pose; "" for less. */
export function magicOf(bytes: ArrayBuffer): string {
  return bytes.byteLength < 4 ? "" : String.fromCharCode(...new Uint8Array(bytes, 0, 4));
}

/** Read a frame message. Throws `WireError` and nothing else, whatever the bytes are. */
export function decodeFrame(bytes: ArrayBuffer): FrameMessage {
  if (bytes.byteLength <= FRAME_HEADER_BYTES || bytes.byteLength > LARGEST_MESSAGE_BYTES)
    throw new WireError("length", `a frame message of ${bytes.byteLength} bytes; expected 385 to 16 MiB`);
  const magic = magicOf(bytes);
  if (magic !== "AGF1") throw new WireError("magic", `a frame message starts with AGF1, not ${JSON.stringify(magic)}`);
  const view = new DataView(bytes);
  const frameId = view.getUint32(8, true);
  const headerBytes = view.getUint16(4, true);
  if (headerBytes !== FRAME_HEADER_BYTES)
    throw new WireError("header", `a header of ${headerBytes} bytes; this page reads 384 (version 1)`, frameId);
  const flags = view.getUint16(6, true);
  const quarterTurns = view.getUint8(298);
  if (quarterTurns > 3) throw new WireError("frame", `${quarterTurns} quarter turns; expected 0 to 3`, frameId);
  const jpeg = new Uint8Array(bytes, FRAME_HEADER_BYTES);
  if (jpeg[0] !== 0xff || jpeg[1] !== 0xd8) throw new WireError("jpeg", "the picture is no JPEG", frameId);
  return {
    frameId,
    t_capture_ns: Number(view.getBigInt64(16, true)),
    t_sent_ns: Number(view.getBigInt64(24, true)),
    lens: readLens(view, frameId),
    quarterTurns,
    soughtJustBefore: (flags & SOUGHT) !== 0,
    pose: (flags & POSE_VALID) !== 0 ? readPose(view, flags, frameId) : null,
    position_s: finite(view.getFloat64(344, true), "frame", "position in the log", frameId),
    jpeg,
  };
}

/** Read a pose message. Throws `WireError` and nothing else. */
export function decodePose(bytes: ArrayBuffer): PoseMessage {
  if (bytes.byteLength !== POSE_BYTES)
    throw new WireError("length", `a pose message of ${bytes.byteLength} bytes; expected ${POSE_BYTES}`);
  const magic = magicOf(bytes);
  if (magic !== "AGP1") throw new WireError("magic", `a pose message starts with AGP1, not ${JSON.stringify(magic)}`);
  const view = new DataView(bytes);
  const headerBytes = view.getUint16(4, true);
  if (headerBytes !== POSE_BYTES)
    throw new WireError("header", `a header of ${headerBytes} bytes; this page reads 112`);
  const flags = view.getUint16(6, true);
  const numbers = [...doubles(view, 24, 3), ...floats(view, 48, 13)];
  if (!numbers.every(Number.isFinite)) throw new WireError("pose", "the pose holds a number that is not finite");
  const [px = 0, py = 0, pz = 0, w = 0, x = 0, y = 0, z = 0, ...rest] = numbers;
  if (Math.abs(Math.hypot(w, x, y, z) - 1) > 1e-3) throw new WireError("pose", "the pose's quaternion is not unit");
  const [vx = 0, vy = 0, vz = 0] = rest.slice(6);
  return {
    seq: view.getUint32(8, true),
    t_ns: Number(view.getBigInt64(16, true)),
    p_site_body_m: [px, py, pz],
    wxyz_site_body: [w, x, y, z],
    variance: rest.slice(0, 6),
    v_site_m_s: [vx, vy, vz],
    headingKnown: (flags & HEADING_KNOWN) !== 0,
    isTruth: (flags & IS_TRUTH) !== 0,
    soughtJustBefore: (flags & SOUGHT) !== 0,
    motionModel: motionModelName(view.getUint8(12), null),
  };
}

function readLens(view: DataView, frameId: number): Lens {
  const [fx = 0, fy = 0, cx = 0, cy = 0] = floats(view, 244, 4);
  const coefficients = floats(view, 260, 8);
  const width_px = view.getUint16(292, true);
  const height_px = view.getUint16(294, true);
  const model = LENS_MODELS[view.getUint8(296)];
  if (width_px < 1 || height_px < 1 || width_px > LARGEST_SIDE_PX || height_px > LARGEST_SIDE_PX)
    throw new WireError("size", `a picture of ${width_px} x ${height_px} pixels`, frameId);
  if (model === undefined) throw new WireError("lens", `unknown lens model ${view.getUint8(296)}`, frameId);
  if (![fx, fy, cx, cy, ...coefficients].every(Number.isFinite) || fx <= 0 || fy <= 0)
    throw new WireError("lens", `focal lengths ${fx}, ${fy}; expected positive, with all of the lens finite`, frameId);
  return { width_px, height_px, fx_px: fx, fy_px: fy, cx_px: cx, cy_px: cy, model, coefficients };
}

function readPose(view: DataView, flags: number, frameId: number): CameraPose {
  const T_site_cam = doubles(view, 32, 16);
  if (!isRigid(T_site_cam)) throw new WireError("pose", "the pose is no rigid motion", frameId);
  const triangle = floats(view, 160, 21);
  const velocity = floats(view, 332, 3);
  if (![...triangle, ...velocity].every(Number.isFinite))
    throw new WireError("pose", "the pose holds a number that is not finite", frameId);
  const [vx = 0, vy = 0, vz = 0] = velocity;
  return {
    frameId: view.getUint32(12, true),
    t_ns: Number(view.getBigInt64(16, true)),
    T_site_cam,
    covariance: symmetric(triangle),
    v_site_m_s: [vx, vy, vz],
    headingKnown: (flags & HEADING_KNOWN) !== 0,
    isTruth: (flags & IS_TRUTH) !== 0,
    motionModel: motionModelName(view.getUint8(297), frameId),
    estimator: readText(view, 300, 32),
  };
}

/** Return the 6 x 6 matrix of which `triangle` is the upper half, row by row. */
export function symmetric(triangle: readonly number[]): readonly number[] {
  const full = new Array<number>(36).fill(0);
  let next = 0;
  for (let row = 0; row < 6; row++) {
    for (let column = row; column < 6; column++) {
      const value = triangle[next++] ?? 0;
      full[6 * row + column] = value;
      full[6 * column + row] = value;
    }
  }
  return full;
}

function motionModelName(code: number, frameId: number | null): string | null {
  if (code === 255) return null;
  if (code > 8) throw new WireError("pose", `unknown motion model ${code}; expected 0 to 8, or 255 for none`, frameId);
  return `P${Math.floor(code / 3)}R${code % 3}`;
}

function finite(value: number, fault: WireFault, what: string, frameId: number): number {
  if (!Number.isFinite(value)) throw new WireError(fault, `the ${what} is not finite`, frameId);
  return value;
}

function doubles(view: DataView, offset: number, count: number): number[] {
  return Array.from({ length: count }, (_, i) => view.getFloat64(offset + 8 * i, true));
}

function floats(view: DataView, offset: number, count: number): number[] {
  return Array.from({ length: count }, (_, i) => view.getFloat32(offset + 4 * i, true));
}

/** Read zero-padded UTF-8; a broken sequence becomes a mark, not an error: it is only shown. */
function readText(view: DataView, offset: number, length: number): string {
  const bytes = new Uint8Array(view.buffer, view.byteOffset + offset, length);
  const end = bytes.indexOf(0);
  return new TextDecoder().decode(end < 0 ? bytes : bytes.subarray(0, end));
}
