/** Which session the page shows: the one that its address names, else the newest. */

import { parseSessions } from "./protocol";

/** Return the session that the address names, if it names one. */
export function askedName(): string | null {
  const replay = /^\/replay\/([^/]+)\/?$/.exec(location.pathname)?.[1];
  return replay === undefined ? new URLSearchParams(location.search).get("session") : decodeURIComponent(replay);
}

/** Return the newest session; null where there is none. */
export async function newestName(): Promise<string | null> {
  try {
    const sessions = parseSessions(await (await fetch("/api/sessions")).json());
    return sessions.at(-1)?.name ?? null;
  } catch {
    return null;
  }
}
