/** How well the parts of a model are known, in words and in colours. Pure. */

import type { Key } from "./language/speech";

export type Evidence = "attested" | "inferred" | "hypothetical";

export const EVIDENCE: readonly Evidence[] = ["attested", "inferred", "hypothetical"];

/** The darker, the surer: blue, magenta and yellow, told apart by every kind of colour vision. */
export const EVIDENCE_COLOURS: Readonly<Record<Evidence, string>> = {
  attested: "#00509d",
  inferred: "#c8639c",
  hypothetical: "#ffd75e",
};

/** What each means, where a site does not say it in its own words. */
export const EVIDENCE_WORDS = {
  attested: "evidence.attested",
  inferred: "evidence.inferred",
  hypothetical: "evidence.hypothetical",
} as const satisfies Readonly<Record<Evidence, Key>>;

/** Read a level of evidence; null for anything else. */
export function parseEvidence(value: unknown): Evidence | null {
  return EVIDENCE.find((evidence) => evidence === value) ?? null;
}
