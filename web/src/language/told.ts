/** What servers and rigs tell, in English, said in the language that is spoken: each sentence is found in the English catalogue. Pure. */

import { en } from "./en";
import { type Key, language, say } from "./speech";

/** What sentences tell of. */
const SENSORS = ["sensor.gps", "sensor.imu", "sensor.camera"] as const;

const SENTENCES = Object.entries(en).flatMap(([key, text]) =>
  key.startsWith("told.") && typeof text === "string" ? [{ key: key as Key, pattern: patternOf(text) }] : [],
);

/** Return a sentence of a server's as a visitor is told it; one that nobody knows stays as it is. */
export function told(sentence: string): string {
  if (language() === "en") return sentence;
  const sensor = SENSORS.find((key) => en[key] === sentence);
  if (sensor !== undefined) return say(sensor);
  for (const { key, pattern } of SENTENCES) {
    const match = pattern.exec(sentence);
    if (match === null) continue;
    const values = Object.entries(match.groups ?? {}).map(([name, value]) => [name, told(value)]);
    return (say as (key: Key, values: Readonly<Record<string, string>>) => string)(key, Object.fromEntries(values));
  }
  return sentence;
}

/** Return what matches a text, and takes out what stands in the place of its names. */
function patternOf(text: string): RegExp {
  const literal = text.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  return new RegExp(`^${literal.replace(/\{(\w+)\}/g, "(?<$1>.+?)")}$`);
}
