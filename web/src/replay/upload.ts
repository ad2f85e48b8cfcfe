/** A recording on its way to the server: its name there, and what is said when it is not taken. Pure. */

import { say } from "../language/speech";

/** What the server allows in a walk's name, and how long it may be. */
const NOT_ALLOWED = /[^A-Za-z0-9._-]+/g;
const LONGEST = 64;

/** Return the name under which a file is brought: its own, as far as the server allows. */
export function nameOf(file: string): string {
  const stem = file
    .replace(/\.mcap$/i, "")
    .replace(NOT_ALLOWED, "-")
    .replace(/^[^A-Za-z0-9]+/, "")
    .slice(0, LONGEST);
  return stem === "" ? "walk" : stem;
}

/** Return another name for the same, where one is taken: "walk", "walk-2", "walk-3". */
export function otherName(name: string, number: number): string {
  const end = `-${number}`;
  return name.slice(0, LONGEST - end.length) + end;
}

/** Return why a recording was not taken: the server's own sentence where it has one to say. */
export function refusalOf(status: number, detail: string): string {
  if (status === 0) return say("replay.drop.lost");
  if (status === 401 || status === 403) return say("replay.drop.operators");
  // a server that shows one walk has no place for others
  if (status === 404 || status === 405 || status === 501) return say("replay.drop.one_walk");
  return detail === "" ? say("replay.drop.failed") : detail;
}
