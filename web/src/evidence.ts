/** How well the parts of a model are known, in words and in colours. Pure. */

export type Evidence = "attested" | "inferred" | "hypothetical";

export const EVIDENCE: readonly Evidence[] = ["attested", "inferred", "hypothetical"];

/** The darker, the surer: blue, magenta and yellow, told apart by every kind of colour vision. */
export const EVIDENCE_COLOURS: Readonly<Record<Evidence, string>> = {
  attested: "#00509d",
  inferred: "#c8639c",
  hypothetical: "#ffd75e",
};

export const EVIDENCE_WORDS: Readonly<Record<Evidence, string>> = {
  attested: "Attested: it stands, or was excavated.",
  inferred: "Inferred: from its plan, its fragments, or buildings like it.",
  hypothetical: "Hypothetical: one way it may have been.",
};

/** Read a level of evidence; null for anything else. */
export function parseEvidence(value: unknown): Evidence | null {
  return EVIDENCE.find((evidence) => evidence === value) ?? null;
}
