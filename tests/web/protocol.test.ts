/** The text messages: what the server sends is read, what nobody would send does no harm. */

import { ProtocolError, parseSession, parseSessions, parseState } from "../../web/src/protocol";
import { parseSite } from "../../web/src/site";
import { forSeeds, type Random } from "./random";

/** As `server/sessions.py` describes a replay. */
const SESSION = {
  name: "walk",
  kind: "replay",
  log: "walk.mcap",
  duration_s: 61.5,
  estimator: "truth",
  estimators: ["truth", "gps-imu/famm"],
  unavailable: { "gps-imu/famm": "This walk has no GPS." },
  playback: { playing: true, position_s: 3.25, speed: 2, looping: false },
  anchor: "here",
  utc_offset_s: 1_777_115_280.25,
  notice: null,
  health: {},
  sharing: false,
  title: "A walk at noon",
  connected: true,
};

function jsonOf(random: Random, depth: number): unknown {
  const kind = random.below(depth > 0 ? 8 : 6);
  switch (kind) {
    case 0:
      return null;
    case 1:
      return random.below(2) === 0;
    case 2:
      return random.between(-1e9, 1e9);
    case 3:
      return ["replay", "live", "", "a/b", "\u0000", "hello"][random.below(6)];
    case 4:
      return -1;
    case 5:
      return {};
    case 6:
      return Array.from({ length: random.below(4) }, () => jsonOf(random, depth - 1));
    default:
      return Object.fromEntries(
        [...Object.keys(SESSION), "type", "session", "monuments", "models", "footprint_en", "speed", "position_s"]
          .filter(() => random.below(3) === 0)
          .map((key) => [key, jsonOf(random, depth - 1)]),
      );
  }
}

test("a session is read as the server wrote it", () => {
  expect(parseSession(SESSION)).toEqual(SESSION);
  expect(parseSessions({ sessions: [SESSION, { ...SESSION, name: "b" }] }).map(({ name }) => name)).toEqual([
    "walk",
    "b",
  ]);
});

test.each([
  ["hello", "rig", "rig"],
  ["hello", "emperor", "viewer"],
  ["state", undefined, null],
])("%s carries the session, and %s is %s", (type, told, role) => {
  const number = type === "hello" ? 3 : null;
  const message = parseState(JSON.stringify({ type, version: 1, role: told, sees: true, number, session: SESSION }));
  expect(message).toEqual({ type: "session", session: parseSession(SESSION), role, number });
});

test("of those who watch the ones with a place are read", () => {
  const eye = { place_site_m: [1, 2, 1.7], heading_rad: 0.5, pitch_rad: -0.1 };
  const seen = [{ number: 2, eye }, { number: 3, eye: { ...eye, place_site_m: [1, null, 2] } }, { eye }];
  const message = parseState(JSON.stringify({ type: "company", watching: 3, seen }));
  expect(message).toEqual({ type: "company", watching: 3, seen: [{ number: 2, eye }] });
  expect(() => parseState('{"type":"company","watching":1,"seen":[null]}')).toThrow(ProtocolError);
});

test("a reply tells what became of a request", () => {
  expect(parseState('{"type":"reply","request_id":"v1","ok":false,"error":"No rig is connected."}')).toEqual({
    type: "reply",
    reply: { requestId: "v1", ok: false, error: "No rig is connected.", didSeek: false },
  });
  expect(parseState('{"type":"reply","request_id":"v2","ok":true,"error":null,"did_seek":true}')).toEqual({
    type: "reply",
    reply: { requestId: "v2", ok: true, error: null, didSeek: true },
  });
});

test("of a rig's health the sentence is read, and what has none is left out", () => {
  const gps = { state: "lost", trouble: true, sentence: "The GPS receiver is gone.", rate_hz: 0 };
  expect(parseSession({ ...SESSION, health: { gps, imu: { trouble: true }, camera: null } }).health).toEqual({
    gps,
  });
  expect(parseSession({ ...SESSION, health: [gps] }).health).toEqual({});
});

test("a message of a newer server is passed over", () => {
  expect(parseState('{"type":"weather","rain":true}')).toBeNull();
});

test("a live session has no playback, and a replay always has one", () => {
  expect(parseSession({ ...SESSION, kind: "live" }).playback).toBeNull();
  expect(parseSession({ name: "a", kind: "replay" }).playback).toEqual({
    playing: false,
    position_s: 0,
    speed: 1,
    looping: false,
  });
});

test("whatever the JSON, a session is read whole or refused with a ProtocolError", () => {
  let read = 0;
  forSeeds(500, (random) => {
    const value = random.below(2) === 0 ? jsonOf(random, 3) : { ...SESSION, [keyOf(random)]: jsonOf(random, 2) };
    try {
      const session = parseSession(value);
      read += 1;
      expect(session.name).not.toBe("");
      expect(session.duration_s).toBeGreaterThanOrEqual(0);
      expect(session.estimators.every((name) => typeof name === "string")).toBe(true);
      expect(Object.values(session.unavailable).every((reason) => typeof reason === "string")).toBe(true);
      expect(session.playback === null).toBe(session.kind === "live");
      if (session.playback) expect(session.playback.position_s).toBeGreaterThanOrEqual(0);
    } catch (error) {
      expect(error).toBeInstanceOf(ProtocolError);
    }
  });
  expect(read).toBeGreaterThan(100);
});

function keyOf(random: Random): string {
  const keys = Object.keys(SESSION);
  return keys[random.below(keys.length)] ?? "name";
}

test("whatever the text or the site, only a ProtocolError escapes", () => {
  forSeeds(500, (random) => {
    const value = jsonOf(random, 4);
    const text = JSON.stringify(value);
    const cut = text.slice(0, random.below(text.length + 1));
    for (const attempt of [
      () => parseState(text),
      () => parseState(cut),
      () => parseSite(value),
      () => parseSessions(value),
    ])
      try {
        attempt();
      } catch (error) {
        expect(error).toBeInstanceOf(ProtocolError);
      }
  });
});
