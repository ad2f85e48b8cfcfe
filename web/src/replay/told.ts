/** What happened on a walk, and estimators, in words. */

import { say, sayNumber } from "../language/speech";
import { clockText } from "../playback";
import { motionWords } from "../words";
import type { Happening } from "./review";

/** Return what happened: "GPS is silent". */
export function happeningWords({ kind, sensor }: Happening): string {
  switch (kind) {
    case "silence":
      return say("replay.silence", { sensor: say(`replay.sensor.${sensor ?? "imu"}`) });
    case "magnetic":
      return say("replay.magnetic");
    case "weak_gps":
      return say("replay.weak_gps");
    case "stop":
      return say("replay.stop");
    case "cut":
      return say("replay.cut");
  }
}

/** Return when: "0:12 to 0:31", or "1:15" for a moment. */
export function spanWords({ from_s, until_s }: Happening): string {
  const [from, until] = [clockText(from_s), clockText(until_s)];
  return from === until ? from : say("replay.span", { from, until });
}

/** Return an estimator's name and its sensors: "Precise", "camera, GPS, inertial". */
export function estimatorWords(name: string): readonly [string, string] {
  if (name === "truth") return [say("replay.estimator.truth"), say("replay.sensors.truth")];
  const [sensors, kind] = name.split("/");
  const kinds = {
    cmm: say("replay.estimator.cmm"),
    famm: say("replay.estimator.famm"),
    dfa: say("replay.estimator.dfa"),
    imm: say("replay.estimator.imm"),
    reduced: say("replay.estimator.reduced"),
    precise: say("replay.estimator.precise"),
  } as const;
  const words = kinds[kind as keyof typeof kinds];
  if (words === undefined) return [name, ""];
  return [words, sensors === "camera-gps-imu" ? say("replay.sensors.camera") : say("replay.sensors.gps")];
}

/** Return an estimator's name in a line: "Precise (camera, GPS, inertial)". */
export function estimatorLine(name: string): string {
  const [kind, sensors] = estimatorWords(name);
  return sensors === "" ? kind : `${kind} (${sensors})`;
}

/** Return a figure, a dash where there is none. */
export function figureText(value: number | null, decimals: number): string {
  return value === null ? "–" : sayNumber(value, decimals);
}

/** Return what the walker does, or how the filter moves, at a place; null where no model is in force. */
export function modelWords(model: string | null, estimator: string): string | null {
  return model === null ? null : motionWords(model, estimator);
}
