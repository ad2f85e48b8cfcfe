/** Which walks there are, asked again and again for everybody on the page who wants to know. */

import { parseSessions, type Session } from "../protocol";

const LOOK_AGAIN_MS = 3000;

/** What was found; walks are hidden from who has not shown a token, and nothing is known while no server answers. */
export type Found = readonly Session[] | "hidden" | "no server";

export class Directory {
  private readonly listeners: ((found: Found) => void)[] = [];
  private found: Found | null = null;

  constructor() {
    void this.look();
  }

  /** Tell what is found, from now on and as it is known already. */
  listen(listener: (found: Found) => void): void {
    this.listeners.push(listener);
    if (this.found !== null) listener(this.found);
  }

  private async look(): Promise<void> {
    const found = await asked();
    this.found = found;
    for (const listener of this.listeners) listener(found);
    window.setTimeout(() => void this.look(), LOOK_AGAIN_MS);
  }
}

async function asked(): Promise<Found> {
  try {
    const answer = await fetch("/api/sessions");
    return answer.status === 401 ? "hidden" : parseSessions(await answer.json());
  } catch {
    return "no server";
  }
}
