/** Whether this device's clock can be believed: beside the server's, which a rig sets by satellite or network. Pure. */

import { say } from "./language/speech";

/** Less than this moves the sun by less than its own width, and is what networks and whole seconds make. */
const BELIEVED_S = 120;

/** Return how much is to be added to this device's clock, seconds; 0 where the server tells no time, or nearly ours. */
export function clockOff(serverDate: string | null, now_ms: number): number {
  const server_ms = serverDate === null ? Number.NaN : Date.parse(serverDate);
  const off_s = (server_ms - now_ms) / 1000;
  return Number.isFinite(off_s) && Math.abs(off_s) > BELIEVED_S ? off_s : 0;
}

/** Return what to say of a clock that is off, or null. */
export function clockWords(off_s: number): string | null {
  if (off_s === 0) return null;
  const much = Math.abs(off_s);
  const direction = say(off_s > 0 ? "clock.behind" : "clock.ahead");
  if (much < 5400) return say("clock.off_minutes", { count: Math.round(much / 60), direction });
  if (much < 172_800) return say("clock.off_hours", { count: Math.round(much / 3600), direction });
  return say("clock.off_days", { count: Math.round(much / 86_400), direction });
}
