/**
 * What the page says to a visitor: one plain sentence, and the numbers in words and units. Pure.
 */

import { say, sayLength, sayNumber } from "./language/speech";
import { told } from "./language/told";
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
  if (s.drawingLost) return say("trouble.drawing");
  if (s.connection === "refused") return say("trouble.refused");
  if (s.connection === "other version") return say("trouble.version");
  if (s.connection === "no session") return noSession(s.asked);
  if (s.connection === "lost") return say("trouble.lost");
  if (s.connection === "connecting") return s.sinceOpened_ms > QUIET_AFTER_MS ? say("trouble.connecting") : null;
  if (s.sincePicture_ms === null && s.sinceOpened_ms > QUIET_AFTER_MS) return noPictures(s);
  if (s.sincePicture_ms !== null && s.sincePicture_ms > QUIET_AFTER_MS && s.playing) return noPictures(s);
  if (s.garbled) return say("trouble.garbled");
  const trouble = Object.values(s.health).find((sensor) => sensor.trouble);
  if (trouble) return told(trouble.sentence);
  if (s.model === "failed") return say("trouble.model_again", { trouble: say("trouble.model") });
  if (s.sincePicture_ms !== null && !s.hasPose) return say("trouble.no_pose");
  if (s.hasPose && !s.headingKnown) return say("trouble.no_heading");
  if (s.model === "loading" && s.sinceOpened_ms > QUIET_AFTER_MS) return say("trouble.loading");
  return s.notice === null ? null : told(s.notice);
}

const SENSORS = { gps: "sensor.gps", imu: "sensor.imu", camera: "sensor.camera" } as const;

function sensorWords(name: string): string {
  const key = Object.entries(SENSORS).find(([known]) => known === name)?.[1];
  return key === undefined ? say("sensor.other", { name }) : say(key);
}

/** Return what has happened to a rig's sensors between two states, or null: a trouble in its own words, or that one is back. */
export function newsOf(before: Readonly<Record<string, Told>>, now: Readonly<Record<string, Told>>): string | null {
  for (const [name, sensor] of Object.entries(now)) {
    if (sensor.trouble && !before[name]?.trouble) return told(sensor.sentence);
    if (!sensor.trouble && before[name]?.trouble) return say("sensor.back", { sensor: sensorWords(name) });
  }
  return null;
}

function noSession(asked: string | null): string {
  return asked === null ? say("trouble.no_walk") : say("trouble.no_such_walk", { name: asked });
}

function noPictures(s: Situation): string {
  const camera = s.health["camera"];
  if (camera?.trouble) return told(camera.sentence);
  if (s.kind === "live") return say("trouble.no_pictures_live");
  return s.playing ? say("trouble.no_pictures") : say("trouble.press_play");
}

/** What a motion model's two indices mean, position or walk first, then rotation. In the paper's filter they are coefficients of its velocities, 0, 1 and 2. */
const COEFFICIENTS = {
  position: ["motion.position_held", "motion.position_steady", "motion.position_doubled"],
  rotation: ["motion.turning_held", "motion.turning_steady", "motion.turning_doubled"],
} as const;

/** In `precise` they are what the walker does. */
const ACTIVITIES = {
  position: ["motion.standing", "motion.walking", "motion.walking_fast"],
  rotation: ["motion.view_still", "motion.view_turning", "motion.view_turning_fast"],
} as const;

/** Return `P1R2` in words, as its estimator means it: "position steady, turning doubled", or "walking, view turning fast". */
export function motionWords(model: string | null, estimator: string): string {
  const match = /^P([012])R([012])$/.exec(model ?? "");
  if (!match) return say("motion.none");
  const words = estimator.endsWith("/precise") ? ACTIVITIES : COEFFICIENTS;
  const [position, rotation] = [Number(match[1]) as 0 | 1 | 2, Number(match[2]) as 0 | 1 | 2];
  return say("motion.two", { position: say(words.position[position]), rotation: say(words.rotation[rotation]) });
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
  if (metres < 0.095) return sayLength(Math.max(0, metres * 100), "centimeter");
  return sayLength(metres, "meter", metres < 9.95 ? 1 : 0);
}

/** Return an angle given in radians as degrees: "0.4°", "12°". */
export function degreesText(angle_rad: number): string {
  if (!Number.isFinite(angle_rad)) return "–";
  const degrees = (angle_rad * 180) / Math.PI;
  if (degrees > 180) return say("number.unknown");
  return say("number.degrees", { value: sayNumber(degrees, degrees < 9.95 ? 1 : 0) });
}

const POINTS = [
  "compass.n",
  "compass.ne",
  "compass.e",
  "compass.se",
  "compass.s",
  "compass.sw",
  "compass.w",
  "compass.nw",
] as const;

/** Return a heading, clockwise from north, as the nearest of eight points. */
export function compassPoint(heading_rad: number): string {
  const eighth = Math.round((heading_rad / (2 * Math.PI)) * 8);
  return say(POINTS[((eighth % 8) + 8) % 8] ?? "compass.n");
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
