/** A guided tour as a value: which stop, whether it plays, how long it has stood there. Pure; times are milliseconds. */

export interface Journey {
  readonly index: number;
  readonly plays: boolean;
  readonly stood_ms: number;
}

/** A text is read aloud at two and a half words a second, and then one looks for a while. */
const MS_PER_WORD = 400;
const LOOK_MS = 3500;
const LEAST_MS = 7000;

/** Return how long a stop is stood at. */
export function stayOf(text: string | null): number {
  const words = text?.split(/\s+/).filter((word) => word !== "").length ?? 0;
  return Math.max(LEAST_MS, MS_PER_WORD * words + LOOK_MS);
}

/** Return a tour that begins. */
export function begun(): Journey {
  return { index: 0, plays: true, stood_ms: 0 };
}

/** Return the tour at another stop; at the ends it stays. */
export function moved(journey: Journey, by: number, stops: number): Journey {
  const index = Math.min(stops - 1, Math.max(0, journey.index + by));
  return { ...journey, index, stood_ms: 0 };
}

export function toggled(journey: Journey, stops: number, stay_ms: number): Journey {
  const isOver = journey.index === stops - 1 && journey.stood_ms >= stay_ms;
  if (!journey.plays && isOver) return begun();
  return { ...journey, plays: !journey.plays };
}

/** Return the tour after some time at its stop: it goes on when that was long enough, and stops at the last one. */
export function after(journey: Journey, passed_ms: number, stay_ms: number, stops: number): Journey {
  if (!journey.plays) return journey;
  const stood_ms = Math.min(stay_ms, journey.stood_ms + passed_ms);
  if (stood_ms < stay_ms) return { ...journey, stood_ms };
  if (journey.index < stops - 1) return { index: journey.index + 1, plays: true, stood_ms: 0 };
  return { ...journey, plays: false, stood_ms };
}
