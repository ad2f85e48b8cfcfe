/** What this browser keeps for its visitor between visits; one that keeps nothing is as good, but forgets. */

/** Return what was kept under a name, if anything. */
export function kept(name: string): string | null {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

/** Keep a text under a name. */
export function keep(name: string, text: string): void {
  try {
    localStorage.setItem(name, text);
  } catch {
    // private windows may refuse
  }
}
