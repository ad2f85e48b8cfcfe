/** Which level of detail a thing is drawn at: the rule of `assets/levels.py`, and a memory so that nothing flickers. Pure. */

/** A thing that is drawn at a finer level keeps it until it is this much further away than where it got it. */
const RELUCTANCE = 1.15;

/**
 * Return the level wanted at a distance: 0 up to the first reach, 1 up to the second, and so on.
 *
 * `current` is the level now drawn, if any: a coarser one than that is wanted only well beyond its reach.
 */
export function levelAt(distance_m: number, reach_m: readonly number[], current: number | null = null): number {
  const beyond = (factor: number): number => reach_m.filter((reach) => distance_m > reach * factor).length;
  const level = beyond(1);
  return current !== null && level > current ? Math.max(current, beyond(RELUCTANCE)) : level;
}

/** Return the level to draw of those that are there: the wanted one, else the next coarser, else the coarsest; null for none. */
export function bestOf(wanted: number, there: readonly number[]): number | null {
  if (there.length === 0) return null;
  const coarser = there.filter((level) => level >= wanted);
  return coarser.length > 0 ? Math.min(...coarser) : Math.max(...there);
}

/** Return what a node changes its level together with: its monument, else itself. */
export function groupOf(name: string, monument: string | null): string {
  return monument ?? name.split("/")[0] ?? name;
}
