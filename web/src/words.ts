/**
 * What the page says to a visitor: one plain sentence, and the numbers in words and units. Pure.
 */

import type { SensorHealth } from "./protocol";

/** What of a sensor's health is put into words. */
type Told = Pick<SensorHealth, "trouble" | "sentence">;

export type Connection = "connecting" | "open" | "lost" | "refused" | "no session" | "other version";

export interface Situation {
  readonly connection: Connection;
  readonly kind: "live" | "replay";
  readonly playing: boolean;
  /** Since the last picture; null before the first. */
  readonly sincePicture_ms: number | null;
  /** Since this page was opened. */
  readonly sinceOpened_ms: number;
  readonly hasPose: boolean;
  readonly headingKnown: boolean;
  /** The session that the address asks for by name; null where any will do. */
  readonly asked: string | null;
  /** The server's own notice, if any. */
  readonly notice: string | null;
  /** How a live rig's sensors are, by name. */
  readonly health: Readonly<Record<string, Told>>;
  readonly model: "loading" | "shown" | "failed";
  /** Whether the browser has taken the graphics away. */
  readonly drawingLost: boolean;
  /** Whether messages come that this page cannot read. */
  readonly garbled: boolean;
}

const QUIET_AFTER_MS = 2500;

/** Return what stands in the visitor's way, most pressing first, or null when all is well. */
export function sentenceFor(s: Situation): string | null {
  if (s.drawingLost) return "The browser has stopped drawing: it begins again by itself, or the page is loaded anew …";
  if (s.connection === "refused")
    return "This page may not watch this walk: open the link that its owner gives you, or show a token at /enter.";
  if (s.connection === "other version") return "This page is of another version than the server: load it anew.";
  if (s.connection === "no session") return noSession(s.asked);
  if (s.connection === "lost") return "The connection is lost: trying again …";
  if (s.connection === "connecting") return s.sinceOpened_ms > QUIET_AFTER_MS ? "Connecting to the walk …" : null;
  if (s.sincePicture_ms === null && s.sinceOpened_ms > QUIET_AFTER_MS) return noPictures(s);
  if (s.sincePicture_ms !== null && s.sincePicture_ms > QUIET_AFTER_MS && s.playing) return noPictures(s);
  if (s.garbled) return "What arrives cannot be read: is the server another version? Going on with what can be.";
  const trouble = Object.values(s.health).find((sensor) => sensor.trouble);
  if (trouble) return trouble.sentence;
  if (s.model === "failed") return `${MODEL_FAILED} This page tries again by itself …`;
  if (s.sincePicture_ms !== null && !s.hasPose)
    return "Finding out where you are: the square appears when the position is known.";
  if (s.hasPose && !s.headingKnown) return "Walk a few steps so that I can find north.";
  if (s.model === "loading" && s.sinceOpened_ms > QUIET_AFTER_MS) return "The square is on its way …";
  return s.notice;
}

const SENSORS: Readonly<Record<string, string>> = {
  gps: "The GPS receiver",
  imu: "The inertial unit",
  camera: "The camera",
};

/** Return what has happened to a rig's sensors between two states, or null: a trouble in its own words, or that one is back. */
export function newsOf(before: Readonly<Record<string, Told>>, now: Readonly<Record<string, Told>>): string | null {
  for (const [name, sensor] of Object.entries(now)) {
    if (sensor.trouble && !before[name]?.trouble) return sensor.sentence;
    if (!sensor.trouble && before[name]?.trouble) return `${SENSORS[name] ?? `The ${name}`} is back.`;
  }
  return null;
}

/** Said on both pages. */
export const MODEL_FAILED =
  "The model of the square could not be loaded: reload the page, or build it anew with agora build.";

function noSession(asked: string | null): string {
  if (asked === null) return "Nobody is walking just now: this page starts by itself when a walk begins.";
  return `There is no walk named ${asked} here: the start page lists those that there are.`;
}

function noPictures(s: Situation): string {
  const camera = s.health["camera"];
  if (camera?.trouble) return camera.sentence;
  if (s.kind === "live") return "No pictures are arriving: is the rig running?";
  return s.playing ? "No pictures here: this part of the recording has none." : "Press play to start the walk.";
}

/** What a motion model's two indices mean: position or walk first, then rotation. */
interface MotionWords {
  readonly position: readonly [string, string, string];
  readonly rotation: readonly [string, string, string];
}

/** In the paper's filter they are coefficients of its velocities, 0, 1 and 2. */
const COEFFICIENTS: MotionWords = {
  position: ["position held", "position steady", "position doubled"],
  rotation: ["turning held", "turning steady", "turning doubled"],
};

/** In `precise` they are what the walker does. */
const ACTIVITIES: MotionWords = {
  position: ["standing", "walking", "walking briskly"],
  rotation: ["view still", "view turning", "view turning fast"],
};

/** Return `P1R2` in words, as its estimator means it: "position steady, turning doubled", or "walking, view turning fast". */
export function motionWords(model: string | null, estimator: string): string {
  const match = /^P([012])R([012])$/.exec(model ?? "");
  if (!match) return "no motion model";
  const words = estimator.endsWith("/precise") ? ACTIVITIES : COEFFICIENTS;
  return `${words.position[Number(match[1])] ?? ""}, ${words.rotation[Number(match[2])] ?? ""}`;
}

/** Three lightnesses for position, three hues for turning; told apart without hue, and never the only carrier. */
const MOTION_COLOURS: Readonly<Record<string, string>> = {
  P0R0: "#9c8f7c",
  P0R1: "#8fa37e",
  P0R2: "#a88f9e",
  P1R0: "#c9a36a",
  P1R1: "#dba24f",
  P1R2: "#d98a6a",
  P2R0: "#f0c987",
  P2R1: "#f2b25c",
  P2R2: "#ee7f55",
};

/** Return the colour of a motion model. */
export function motionColour(model: string | null): string {
  return MOTION_COLOURS[model ?? ""] ?? "#7d756a";
}

/** Return metres in the precision that means something: "4 cm", "0.8 m", "12 m". */
export function metresText(metres: number): string {
  if (!Number.isFinite(metres)) return "–";
  if (metres < 0.095) return `${Math.max(0, Math.round(metres * 100))} cm`;
  return metres < 9.95 ? `${metres.toFixed(1)} m` : `${Math.round(metres)} m`;
}

/** Return an angle given in radians as degrees: "0.4°", "12°". */
export function degreesText(angle_rad: number): string {
  if (!Number.isFinite(angle_rad)) return "–";
  const degrees = (angle_rad * 180) / Math.PI;
  if (degrees > 180) return "unknown";
  return degrees < 9.95 ? `${degrees.toFixed(1)}°` : `${Math.round(degrees)}°`;
}

const POINTS: readonly string[] = [
  "north",
  "north-east",
  "east",
  "south-east",
  "south",
  "south-west",
  "west",
  "north-west",
];

/** Return a heading, clockwise from north, as the nearest of eight points. */
export function compassPoint(heading_rad: number): string {
  const eighth = Math.round((heading_rad / (2 * Math.PI)) * 8);
  return POINTS[((eighth % 8) + 8) % 8] ?? "north";
}

/** Return the larger half-axis of the 1-sigma ellipse on the ground, metres, from a 6 x 6 covariance. */
export function horizontalSigma(covariance: readonly number[]): number {
  const [ee = 0, en = 0] = covariance;
  const nn = covariance[7] ?? 0;
  const middle = (ee + nn) / 2;
  return Math.sqrt(Math.max(0, middle + Math.hypot((ee - nn) / 2, en)));
}

/** Return the 1-sigma of the heading, radians, from a 6 x 6 covariance (rotation about up, site axes). */
export function headingSigma(covariance: readonly number[]): number {
  return Math.sqrt(Math.max(0, covariance[35] ?? 0));
}
