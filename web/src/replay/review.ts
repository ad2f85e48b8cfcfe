/** What the server tells of a recorded walk beside its pictures (`server/reviewing/`): JSON to values. Pure. */

import { fields, list, number, text_ } from "../protocol";

export type EventKind = "silence" | "magnetic" | "weak_gps" | "stop" | "cut";
export type Sensor = "imu" | "mag" | "gps" | "camera";

export interface Happening {
  readonly kind: EventKind;
  readonly from_s: number;
  readonly until_s: number;
  /** Whose silence it is. */
  readonly sensor: Sensor | null;
}

export interface Timeline {
  readonly duration_s: number;
  /** When each picture arrived, in order. */
  readonly pictures_s: readonly number[];
  readonly happenings: readonly Happening[];
  readonly hasTruth: boolean;
}

/** Where nothing is known, null: a curve has a gap there. */
export type Curve = readonly (number | null)[];

/** What an estimator made of the walk: curves over `t_s`, or over `innovation_s`, and its figures as `agora evaluate` has them. */
export interface Course {
  readonly estimator: string;
  readonly t_s: readonly number[];
  readonly heading_deg: Curve;
  readonly sigma_m: Curve;
  readonly sigma_heading_deg: Curve;
  readonly error_m: Curve;
  readonly heading_error_deg: Curve;
  readonly innovation_s: readonly number[];
  readonly innovation_m: Curve;
  readonly innovation_deg: Curve;
  /** From when on which motion model was in force. */
  readonly models: readonly (readonly [number, string])[];
  readonly figures: Figures;
}

/** The figures that the page shows; null where there are none. */
export interface Figures {
  readonly ate_m: number | null;
  readonly heading_deg: number | null;
  readonly tilt_deg: number | null;
  readonly filter_m: number | null;
  readonly gps_m: number | null;
}

const KINDS: readonly EventKind[] = ["silence", "magnetic", "weak_gps", "stop", "cut"];
const SENSORS: readonly Sensor[] = ["imu", "mag", "gps", "camera"];

/** Read a timeline. */
export function parseTimeline(value: unknown): Timeline {
  const timeline = fields(value, "timeline");
  return {
    duration_s: Math.max(0, number(timeline["duration_s"], 0)),
    pictures_s: numbers(timeline["pictures_s"]),
    happenings: list(timeline["events"]).flatMap(parseHappening),
    hasTruth: timeline["has_truth"] === true,
  };
}

/** Read one; of a kind that this page does not know there is none. */
function parseHappening(value: unknown): Happening[] {
  const event = fields(value, "event");
  const kind = KINDS.find((known) => known === event["kind"]);
  const from_s = number(event["from_s"], Number.NaN);
  const until_s = number(event["until_s"], Number.NaN);
  if (kind === undefined || !Number.isFinite(from_s + until_s)) return [];
  return [{ kind, from_s, until_s, sensor: SENSORS.find((known) => known === event["sensor"]) ?? null }];
}

/** Read a course. */
export function parseCourse(value: unknown): Course {
  const course = fields(value, "course");
  return {
    estimator: text_(course["estimator"], ""),
    t_s: numbers(course["t_s"]),
    heading_deg: curve(course["heading_deg"]),
    sigma_m: curve(course["sigma_m"]),
    sigma_heading_deg: curve(course["sigma_heading_deg"]),
    error_m: curve(course["error_m"]),
    heading_error_deg: curve(course["heading_error_deg"]),
    innovation_s: numbers(course["innovation_s"]),
    innovation_m: curve(course["innovation_m"]),
    innovation_deg: curve(course["innovation_deg"]),
    models: list(course["models"]).flatMap((entry): (readonly [number, string])[] => {
      const [from_s, model] = list(entry);
      return typeof from_s === "number" && typeof model === "string" ? [[from_s, model]] : [];
    }),
    figures: parseFigures(fields(course["figures"], "figures")),
  };
}

function parseFigures(figures: Readonly<Record<string, unknown>>): Figures {
  const at = (...keys: string[]): number | null => {
    let value: unknown = figures;
    for (const key of keys)
      value = typeof value === "object" && value !== null ? (value as Record<string, unknown>)[key] : null;
    return typeof value === "number" && Number.isFinite(value) ? value : null;
  };
  return {
    ate_m: at("truth", "ate_rmse_m"),
    heading_deg: at("truth", "heading_rmse_deg"),
    tilt_deg: at("truth", "tilt_rmse_deg"),
    filter_m: at("filter_error_m", "mean"),
    gps_m: at("gps", "ate_rmse_m"),
  };
}

function numbers(value: unknown): readonly number[] {
  return list(value).filter((entry): entry is number => typeof entry === "number" && Number.isFinite(entry));
}

function curve(value: unknown): Curve {
  return list(value).map((entry) => (typeof entry === "number" && Number.isFinite(entry) ? entry : null));
}

/** Return the motion model in force at a time; null where there is none. */
export function modelAt(course: Course, t_s: number): string | null {
  let found: string | null = null;
  for (const [from_s, model] of course.models) {
    if (from_s > t_s) break;
    found = model;
  }
  return found;
}

/** Return what happens at a time. */
export function happeningsAt(timeline: Timeline, t_s: number, slack_s = 0): readonly Happening[] {
  return timeline.happenings.filter(({ from_s, until_s }) => from_s - slack_s <= t_s && t_s <= until_s + slack_s);
}
