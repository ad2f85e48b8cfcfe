/**
 * A view of the square as an address, and back: who opens it anew sees the same. Pure.
 *
 * It stands behind the `#`, which no server is told; a question (`?model=today&evidence=1&view=temple`) is read as well, for
 * links that are written by hand. Whatever cannot be read is as if it was not there.
 */

import type { Vector3 } from "../frames";
import { type Eye, STEEPEST_RAD, tilted, turned } from "./eye";
import { WAYS, type Way } from "./way";

export interface Shown {
  readonly eye: Eye | null;
  readonly way: Way | null;
  /** How far ahead the middle of the orbit is. */
  readonly about_m: number | null;
  /** How much of AD 150 is shown, 0 to 1. */
  readonly past: number | null;
  /** Solar hour of the light. */
  readonly hour: number | null;
  readonly isTinted: boolean;
  /** Chosen reconstructions, by monument. */
  readonly variants: ReadonlyMap<string, string>;
  /** The place of the tour that was asked for. */
  readonly stop: string | null;
}

const FARTHEST_M = 1000;
const DEGREES = 180 / Math.PI;
const NAME = /^[a-z0-9_]{1,64}$/;

/** Read the two parts of an address. */
export function readAddress(search: string, hash: string): Shown {
  const [question, view] = [new URLSearchParams(search), new URLSearchParams(hash.replace(/^#/, ""))];
  const get = (name: string): string | null => view.get(name) ?? question.get(name);
  const model = get("model");
  const past = numbers(get("past"), 1, [0, 1])?.[0] ?? null;
  const stop = get("view");
  return {
    eye: readEye(get("at"), get("look")),
    way: WAYS.find((way) => way === get("way")) ?? null,
    about_m: numbers(get("about"), 1, [0.1, FARTHEST_M])?.[0] ?? null,
    past: past ?? (model === "today" ? 0 : model === "roman" ? 1 : null),
    hour: numbers(get("hour"), 1, [0, 24])?.[0] ?? null,
    isTinted: get("evidence") === "1",
    variants: new Map(
      (get("variants") ?? "").split(",").flatMap((pair): [string, string][] => {
        const [monument = "", variant = ""] = pair.split(":");
        return NAME.test(monument) && NAME.test(variant) ? [[monument, variant]] : [];
      }),
    ),
    stop: stop !== null && NAME.test(stop) ? stop : null,
  };
}

/** Return what stands behind the `#`; to the centimetre and the hundredth of a degree. */
export function hashOf(shown: Shown): string {
  const { eye, way, about_m, past, hour, isTinted, variants, stop } = shown;
  const parts: [string, string][] = [];
  if (eye) {
    parts.push(["at", eye.place_site_m.map(exact).join(",")]);
    parts.push(["look", [eye.heading_rad * DEGREES, eye.pitch_rad * DEGREES].map(exact).join(",")]);
  }
  if (way) parts.push(["way", way]);
  if (about_m !== null) parts.push(["about", exact(about_m)]);
  if (past !== null) parts.push(["past", exact(past)]);
  if (hour !== null) parts.push(["hour", exact(hour)]);
  if (isTinted) parts.push(["evidence", "1"]);
  if (variants.size > 0) parts.push(["variants", [...variants].map((pair) => pair.join(":")).join(",")]);
  if (stop !== null) parts.push(["view", stop]);
  return `#${parts.map(([name, value]) => `${name}=${value}`).join("&")}`;
}

function readEye(at: string | null, look: string | null): Eye | null {
  const place = numbers(at, 3, [-FARTHEST_M, FARTHEST_M]);
  const [heading_deg, pitch_deg] = numbers(look, 2, [-360, 360]) ?? [0, 0];
  if (!place || heading_deg === undefined || pitch_deg === undefined) return null;
  if (Math.abs(pitch_deg / DEGREES) > STEEPEST_RAD + 0.01) return null;
  return {
    place_site_m: place as unknown as Vector3,
    heading_rad: turned(heading_deg / DEGREES),
    pitch_rad: tilted(pitch_deg / DEGREES),
  };
}

function numbers(text: string | null, count: number, [low, high]: readonly [number, number]): readonly number[] | null {
  if (text === null || text === "") return null;
  const values = text.split(",").map((part) => (part.trim() === "" ? Number.NaN : Number(part)));
  return values.length === count && values.every((value) => value >= low && value <= high) ? values : null;
}

function exact(value: number): string {
  return String(Number(value.toFixed(2)));
}
