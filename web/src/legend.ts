/** What the colours of the evidence mean, in a list. DOM only. */

import { EVIDENCE, EVIDENCE_COLOURS, EVIDENCE_WORDS } from "./evidence";
import { say } from "./language/speech";
import type { Site } from "./site";

/** Fill a list with the levels of evidence, each in its colour, in the site's words. */
export function fillLegend(legend: HTMLElement, site: Site): void {
  legend.replaceChildren(
    ...EVIDENCE.map((evidence) => {
      const row = document.createElement("li");
      row.dataset["evidence"] = evidence;
      row.textContent = site.evidence[evidence] ?? say(EVIDENCE_WORDS[evidence]);
      return row;
    }),
  );
  for (const evidence of EVIDENCE)
    document.documentElement.style.setProperty(`--${evidence}`, EVIDENCE_COLOURS[evidence]);
}
