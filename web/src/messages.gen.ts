/** Written by `make wire` from server/messages.py; never edited by hand. */

export const VERSION = 1;
export const SUBPROTOCOL = "agora.v1";
export const FRAME_HEADER_BYTES = 384;
export const POSE_BYTES = 112;
export const MAX_FRAME_BYTES = 4194304;
export const FORBIDDEN = 4403;
export const NO_SESSION = 4404;
export const OTHER_VERSION = 4406;
export const REPLACED = 4409;
export const ENDED = 4410;
export const RESTART = 1012;

/** A viewer has drawn, or dropped, this frame. */
export interface Ack {
  readonly type: "ack";
  readonly frame_id: number;
}

/** A visitor has pointed at a landmark in a picture. */
export interface Tap {
  readonly kind: "tap";
  readonly frame_id: number;
  /** Of the picture as stored; (0, 0) is the centre of its first pixel. */
  readonly place_px: readonly [number, number];
  readonly sigma_px: number;
  readonly point_site_m: readonly [number, number, number];
}

/** A visitor has shown on the plan where the rig is. */
export interface Here {
  readonly kind: "here";
  readonly e_m: number;
  readonly n_m: number;
  readonly sigma_m: number;
}

/** A visitor takes the last tap or place back. */
export interface TakeBack {
  readonly kind: "undo";
}

/** A viewer asks the rig for something. */
export interface ControlRequest {
  readonly type: "control";
  readonly request_id: string;
  readonly action:
    | "align"
    | "estimator"
    | "figures"
    | "loop"
    | "pause"
    | "play"
    | "seek"
    | "settings"
    | "share"
    | "speed";
  /** Seconds for `seek`, a factor for `speed`, a name for `estimator`, an alignment for `align`, whether to for `loop` and for `share`, `KEY=VALUE` for `settings`, and an empty text for the usual ones again. */
  readonly value?: boolean | number | string | Tap | Here | TakeBack | null;
}

/** Where somebody stands in the virtual square, and where they look. */
export interface Eye {
  readonly place_site_m: readonly [number, number, number];
  /** Clockwise from north. */
  readonly heading_rad: number;
  /** Upwards from the level. */
  readonly pitch_rad: number;
}

/** A viewer shows the others where it looks from: at most ten times a second, and again within ten seconds. */
export interface Look {
  readonly type: "look";
  /** Null for: no longer. */
  readonly eye: Eye | null;
}

/** Where a replay stands. */
export interface Playback {
  readonly playing: boolean;
  readonly position_s: number;
  readonly speed: number;
  readonly looping: boolean;
}

/** How one sensor of a live rig is. */
export interface SensorHealth {
  /** Whether somebody should do something. */
  readonly trouble: boolean;
  /** What is the matter and what to do; or that all is well. */
  readonly sentence: string;
  readonly state: string;
  readonly rate_hz: number;
}

/** A session, as viewers and `/api/sessions` get it: every field, always. */
export interface Session {
  /** Its address: `/ws/view/NAME`. */
  readonly name: string;
  /** What an operator calls it, to be read in the place of its name; null for nothing. */
  readonly title: string | null;
  readonly kind: "live" | "replay";
  /** The recording that is played; null for a live walk. */
  readonly log: string | null;
  readonly duration_s: number;
  readonly estimator: string;
  readonly estimators: readonly string[];
  /** Estimators that this session cannot run, with the reason. */
  readonly unavailable: Readonly<Record<string, string>>;
  /** Null for a live walk. */
  readonly playback: Playback | null;
  readonly anchor: "here" | "site";
  /** What a picture's stamp needs for the seconds since 1970 (UTC), by which the sun is found; null where nobody knows. */
  readonly utc_offset_s: number | null;
  /** What whoever watches should know. */
  readonly notice: string | null;
  /** How a live rig's sensors are, by name; empty for a replay. */
  readonly health: Readonly<Record<string, SensorHealth>>;
  /** Whether everybody who watches sees the camera picture; else the walker's own view alone. */
  readonly sharing: boolean;
  /** Whether the rig is there. */
  readonly connected: boolean;
}

/** The first message to a viewer. */
export interface Hello {
  readonly type: "hello";
  /** Of the wire format, on this connection. */
  readonly version: number;
  /** As whom this viewer is here; `rig` is the walker, who alone switches sharing. */
  readonly role: "admin" | "local" | "operator" | "rig" | "viewer";
  /** Whether this viewer gets the camera picture though it is not shared; else an empty one stands in its place. */
  readonly sees: boolean;
  /** Of this viewer among those who watch, from one; see `Company`. */
  readonly number: number;
  readonly session: Session;
}

/** The session has changed: the whole of it anew. */
export interface SessionNews {
  readonly type: "state";
  readonly session: Session;
}

/** What became of a request. */
export interface ControlReply {
  readonly type: "reply";
  readonly request_id: string;
  readonly ok: boolean;
  readonly error: string | null;
  readonly did_seek: boolean;
}

/** One of those who watch, and has said from where. */
export interface Companion {
  /** As in its own `hello`. */
  readonly number: number;
  readonly eye: Eye;
}

/** Who watches: the whole of it anew, at most four times a second. Nothing here tells who they are. */
export interface Company {
  readonly type: "company";
  /** How many there are, the reader among them. */
  readonly watching: number;
  /** Those who have said where they look from, at most 32, the reader among them. */
  readonly seen: readonly Companion[];
}

export type FromViewer = Ack | ControlRequest | Look;

export type ToViewer = Hello | SessionNews | ControlReply | Company;
