/**
 * The text messages and HTTP answers: JSON to values, or one `ProtocolError`. No socket and no DOM in here.
 */

import type { Companion, Hello, Playback, SensorHealth, Session } from "./messages.gen";

export type { Playback, SensorHealth, Session };

export type SessionKind = Session["kind"];

export interface Reply {
  readonly requestId: string;
  readonly ok: boolean;
  readonly error: string | null;
  readonly didSeek: boolean;
}

/** `role` and `number` come with the first message alone: as whom this page is here, and as the how manieth. */
export type StateMessage =
  | {
      readonly type: "session";
      readonly session: Session;
      readonly role: Hello["role"] | null;
      readonly number: number | null;
    }
  | { readonly type: "company"; readonly watching: number; readonly seen: readonly Companion[] }
  | { readonly type: "reply"; readonly reply: Reply };

/** Text that is not what it claims to be. */
export class ProtocolError extends Error {
  constructor(message: string) {
    super(message);
    this.name = "ProtocolError";
  }
}

/** A JSON object. */
export type Fields = Readonly<Record<string, unknown>>;

/** Read a text message of the state plane; null for a type that this page does not know (a newer server's). */
export function parseState(text: string): StateMessage | null {
  const message = fields(parseJson(text), "message");
  switch (message["type"]) {
    case "hello":
      return {
        type: "session",
        session: parseSession(message["session"]),
        role: parseRole(message["role"]),
        number: number(message["number"], 0) || null,
      };
    case "state":
      return { type: "session", session: parseSession(message["session"]), role: null, number: null };
    case "company":
      return {
        type: "company",
        watching: number(message["watching"], 0),
        seen: list(message["seen"]).flatMap(parseCompanion),
      };
    case "reply":
      return {
        type: "reply",
        reply: {
          requestId: text_(message["request_id"], ""),
          ok: message["ok"] === true,
          error: typeof message["error"] === "string" ? message["error"] : null,
          didSeek: message["did_seek"] === true,
        },
      };
    default:
      return null;
  }
}

/** Read one session. */
export function parseSession(value: unknown): Session {
  const session = fields(value, "session");
  const name = session["name"];
  if (typeof name !== "string" || name === "") throw new ProtocolError("a session without a name");
  const kind: SessionKind = session["kind"] === "live" ? "live" : "replay";
  return {
    name,
    title: text_(session["title"], "") || null,
    kind,
    log: typeof session["log"] === "string" ? session["log"] : null,
    duration_s: Math.max(0, number(session["duration_s"], 0)),
    estimator: text_(session["estimator"], ""),
    estimators: list(session["estimators"]).filter((entry) => typeof entry === "string"),
    unavailable: texts(session["unavailable"]),
    playback: kind === "live" ? null : parsePlayback(session["playback"]),
    anchor: session["anchor"] === "here" ? "here" : "site",
    utc_offset_s: typeof session["utc_offset_s"] === "number" ? number(session["utc_offset_s"], 0) : null,
    notice: typeof session["notice"] === "string" && session["notice"] !== "" ? session["notice"] : null,
    health: parseHealth(session["health"]),
    sharing: session["sharing"] === true,
    connected: session["connected"] !== false,
  };
}

const ROLES: readonly Hello["role"][] = ["admin", "local", "operator", "rig", "viewer"];

/** Read a role; one that this page does not know may do no more than watch. */
function parseRole(value: unknown): Hello["role"] {
  return ROLES.find((role) => role === value) ?? "viewer";
}

/** Read one who watches; what has no place is nobody. */
function parseCompanion(value: unknown): Companion[] {
  const companion = fields(value, "companion");
  const eye = fields(companion["eye"], "eye");
  const [e, n, u] = list(eye["place_site_m"]).map((entry) => number(entry, Number.NaN));
  const told = number(companion["number"], Number.NaN);
  if (e === undefined || n === undefined || u === undefined || !Number.isFinite(e + n + u + told)) return [];
  const heading_rad = number(eye["heading_rad"], 0);
  return [{ number: told, eye: { place_site_m: [e, n, u], heading_rad, pitch_rad: number(eye["pitch_rad"], 0) } }];
}

/** Read how sensors are; what is not that is left out. */
function parseHealth(value: unknown): Readonly<Record<string, SensorHealth>> {
  if (typeof value !== "object" || value === null || Array.isArray(value)) return {};
  const sensors = Object.entries(value as Fields).flatMap(([name, sensor]): [string, SensorHealth][] => {
    if (typeof sensor !== "object" || sensor === null) return [];
    const { trouble, sentence, state, rate_hz } = sensor as Fields;
    if (typeof sentence !== "string") return [];
    return [[name, { trouble: trouble === true, sentence, state: text_(state, ""), rate_hz: number(rate_hz, 0) }]];
  });
  return Object.fromEntries(sensors);
}

/** Read the list of `GET /api/sessions`, in the server's order. */
export function parseSessions(value: unknown): readonly Session[] {
  return list(fields(value, "sessions")["sessions"]).map(parseSession);
}

function parsePlayback(value: unknown): Playback {
  const playback = typeof value === "object" && value !== null ? fields(value, "playback") : {};
  return {
    playing: playback["playing"] === true,
    position_s: Math.max(0, number(playback["position_s"], 0)),
    speed: number(playback["speed"], 1),
    looping: playback["looping"] === true,
  };
}

function parseJson(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new ProtocolError(`a text message that is no JSON: ${String(error)}`);
  }
}

/** Return a value as an object; `what` it should be is named where it is none. */
export function fields(value: unknown, what: string): Fields {
  if (typeof value !== "object" || value === null || Array.isArray(value))
    throw new ProtocolError(`the ${what} is no JSON object`);
  return value as Fields;
}

/** Return a value as a list; anything else is empty. */
export function list(value: unknown): readonly unknown[] {
  return Array.isArray(value) ? value : [];
}

/** Return a value as a number; anything else is `otherwise`. */
export function number(value: unknown, otherwise: number): number {
  return typeof value === "number" && Number.isFinite(value) ? value : otherwise;
}

/** Return a value as a text; anything else is `otherwise`. */
export function text_(value: unknown, otherwise: string): string {
  return typeof value === "string" ? value : otherwise;
}

/** Return the texts of an object by their keys. */
export function texts(value: unknown): Readonly<Record<string, string>> {
  if (typeof value !== "object" || value === null) return {};
  return Object.fromEntries(
    Object.entries(value).filter((entry): entry is [string, string] => typeof entry[1] === "string"),
  );
}
