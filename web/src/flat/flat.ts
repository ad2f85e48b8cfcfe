/** The start page where nothing can be drawn in three dimensions: the square as a plan, its monuments as a list, the tour as a text. DOM only. */

import { describe } from "../describe";
import { descriptionWords } from "../description";
import { EVIDENCE_WORDS, parseEvidence } from "../evidence";
import { say } from "../language/speech";
import { fillLegend } from "../legend";
import type { Monument, Site, View } from "../site";
import { FlatPlan } from "./plan";

/** As much as an eye takes in at one look. */
const HALF_RAD = Math.PI / 6;

/** Show a site in the place of its model; what changes for everyone is moved to the end of it. */
export function showFlat(site: Site, everyone: Element | null): void {
  document.body.classList.add("flat");
  const article = document.createElement("article");
  article.id = "flat";
  const places = site.monuments.map((monument) => placeOf(monument, site));
  const plan = new FlatPlan(site.monuments, (index) => {
    const place = places[index];
    if (place === undefined) return;
    place.open = true;
    place.scrollIntoView({ block: "nearest" });
    place.querySelector("summary")?.focus();
  });
  places.forEach((place, index) => {
    place.ontoggle = () => plan.mark(index, place.open);
  });
  const legend = document.createElement("ul");
  legend.className = "legend";
  fillLegend(legend, site);
  article.append(
    made("p", say("flat.lead"), "lead"),
    plan.figure,
    section(say("places.title"), [listOf("ol", places), legend]),
  );
  if (site.views.some(({ text }) => text !== null)) article.append(section(say("tour.short"), [tourOf(site)]));
  if (everyone) article.append(everyone);
  document.querySelector("main")?.replaceChildren(article);
}

/** Return a monument as a line that opens, and tells of it. */
function placeOf({ name, caption, evidence, sources, isReviewed }: Monument, site: Site): HTMLDetailsElement {
  const details = document.createElement("details");
  details.append(made("summary", name));
  if (caption !== null) details.append(made("p", caption));
  const level = parseEvidence(evidence);
  if (level !== null) {
    const words = made("p", site.evidence[level] ?? say(EVIDENCE_WORDS[level]));
    words.dataset["evidence"] = level;
    details.append(words);
  }
  if (sources.length > 0) details.append(made("p", say("card.source", { sources: sources.join("; ") }), "quiet"));
  if (!isReviewed) details.append(made("p", say("card.unreviewed"), "quiet"));
  return details;
}

/** Return the tour: each stop's name, what a guide says there, and what would be seen. */
function tourOf(site: Site): HTMLElement {
  const names = new Map(site.monuments.map(({ id, name }) => [id, name]));
  const solids = site.monuments.filter(({ footprint }) => footprint.length > 2);
  const stops = site.views.filter(({ text }) => text !== null);
  const seen = ({ e_m, n_m, heading_rad }: View): string =>
    descriptionWords(describe({ e_m, n_m, u_m: site.eye_height_m, heading_rad, half_rad: HALF_RAD }, solids), names);
  return listOf(
    "ol",
    stops.map((stop) => {
      const part = document.createElement("div");
      part.append(made("h3", stop.name), made("p", stop.text ?? ""), made("p", seen(stop), "quiet"));
      return part;
    }),
  );
}

function section(title: string, content: readonly HTMLElement[]): HTMLElement {
  const part = document.createElement("section");
  part.append(made("h2", title), ...content);
  return part;
}

function listOf(kind: "ol" | "ul", items: readonly HTMLElement[]): HTMLElement {
  const list = document.createElement(kind);
  list.append(
    ...items.map((item) => {
      const row = document.createElement("li");
      row.append(item);
      return row;
    }),
  );
  return list;
}

function made(kind: string, text: string, className = ""): HTMLElement {
  const part = document.createElement(kind);
  part.textContent = text;
  if (className !== "") part.className = className;
  return part;
}
