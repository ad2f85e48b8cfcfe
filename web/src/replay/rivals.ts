/** Estimators side by side: which are drawn, what each is off by, and the one that the picture is drawn by. DOM only. */

import { say } from "../language/speech";
import { type EstimatorChoice, estimatorChoices } from "../playback";
import type { Session } from "../protocol";
import type { Chosen } from "./curves";
import type { Course, Figures } from "./review";
import { estimatorWords, figureText } from "./told";

/** More curves than this are not told apart. */
export const MOST_DRAWN = 4;

type Known = Course | "asked" | { readonly refused: string };

/** A figure of the table, how many decimals it has, and the name of its column. */
const COLUMNS: readonly (readonly [keyof Figures, number, "ate" | "heading" | "tilt" | "filter"])[] = [
  ["ate_m", 2, "ate"],
  ["heading_deg", 2, "heading"],
  ["tilt_deg", 2, "tilt"],
  ["filter_m", 2, "filter"],
];

export class Rivals {
  private session: Session | null = null;
  private readonly known = new Map<string, Known>();
  /** Colours by estimator, of those that are drawn. */
  private readonly colours = new Map<string, number>();
  private listed = "";

  /**
   * `ask` works out what an estimator makes of the walk, `changed` is called with the courses that are to be drawn,
   * and `use` lets the picture be drawn by another estimator.
   */
  constructor(
    private readonly body: HTMLElement,
    private readonly note: HTMLElement,
    private readonly ask: (estimator: string) => Promise<Course>,
    private readonly changed: (chosen: readonly Chosen[]) => void,
    private readonly use: (estimator: string) => void,
  ) {}

  /** Show a session's estimators. */
  show(session: Session): void {
    this.session = session;
    const listed = JSON.stringify([session.estimator, session.estimators, session.unavailable]);
    if (listed !== this.listed) this.list();
    this.listed = listed;
  }

  /** Draw the curves of the estimator that the picture is drawn by. */
  begin(): void {
    const estimator = this.session?.estimator ?? "";
    if (estimator !== "") void this.choose(estimator);
  }

  /** Work out all that the walk allows, one after another. */
  async compareAll(): Promise<void> {
    for (const { name, reason } of this.session ? estimatorChoices(this.session) : [])
      if (reason === null) await this.learn(name);
  }

  /** Return what is known of an estimator. */
  courseOf(estimator: string): Course | null {
    const known = this.known.get(estimator);
    return known !== undefined && known !== "asked" && "figures" in known ? known : null;
  }

  private async choose(name: string): Promise<void> {
    const taken = new Set(this.colours.values());
    const free = [...Array(MOST_DRAWN).keys()].find((colour) => !taken.has(colour));
    if (free === undefined) return;
    this.colours.set(name, free);
    this.list();
    await this.learn(name);
    this.tell();
  }

  private leave(name: string): void {
    this.colours.delete(name);
    this.list();
    this.tell();
  }

  private async learn(name: string): Promise<void> {
    if (this.courseOf(name) || this.known.get(name) === "asked") return;
    this.known.set(name, "asked");
    this.list();
    try {
      this.known.set(name, await this.ask(name));
    } catch (error) {
      this.known.set(name, { refused: error instanceof Error ? error.message : "" });
      this.colours.delete(name);
    }
    this.list();
  }

  private tell(): void {
    const chosen = [...this.colours].flatMap(([name, colour]): Chosen[] => {
      const course = this.courseOf(name);
      return course ? [{ course, colour }] : [];
    });
    this.changed(chosen);
  }

  private list(): void {
    const { session } = this;
    if (session === null) return;
    const focus = document.activeElement instanceof HTMLElement ? document.activeElement.dataset["focus"] : undefined;
    const isShown = ({ name }: EstimatorChoice): boolean => name === session.estimator;
    const choices = estimatorChoices(session);
    const sorted = [...choices.filter(isShown), ...choices.filter((choice) => !isShown(choice))];
    this.body.replaceChildren(...sorted.map((choice) => this.row(choice.name, choice.reason, isShown(choice))));
    if (focus !== undefined) this.body.querySelector<HTMLElement>(`[data-focus="${CSS.escape(focus)}"]`)?.focus();
    const gps_m = [...this.known.keys()]
      .map((name) => this.courseOf(name)?.figures.gps_m ?? null)
      .find((m) => m !== null);
    this.note.textContent = gps_m == null ? "" : say("replay.rivals.gps", { error: figureText(gps_m, 2) });
  }

  private row(name: string, reason: string | null, isShown: boolean): HTMLTableRowElement {
    const row = document.createElement("tr");
    const known = this.known.get(name);
    const refused = reason ?? (typeof known === "object" && "refused" in known ? known.refused : null);
    row.className = isShown ? "shown" : "";
    row.append(this.nameCell(name, refused), this.shownCell(name, refused, isShown));
    if (refused !== null) row.append(cell(refused === "" ? say("replay.rivals.failed") : refused, COLUMNS.length));
    else if (known === "asked") row.append(cell(say("replay.rivals.working"), COLUMNS.length));
    else {
      const course = this.courseOf(name);
      row.append(...COLUMNS.map(([key, decimals]) => cell(course ? figureText(course.figures[key], decimals) : "")));
    }
    return row;
  }

  /** The name, and whether its curves are drawn. */
  private nameCell(name: string, refused: string | null): HTMLTableCellElement {
    const head = document.createElement("th");
    head.scope = "row";
    head.title = name;
    const label = document.createElement("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.dataset["focus"] = `draw ${name}`;
    const colour = this.colours.get(name);
    box.checked = colour !== undefined;
    box.disabled = refused !== null || (colour === undefined && this.colours.size >= MOST_DRAWN);
    if (colour !== undefined) label.dataset["colour"] = String(colour);
    box.onchange = () => (box.checked ? void this.choose(name) : this.leave(name));
    const [kind, sensors] = estimatorWords(name);
    const words = document.createElement("span");
    const detail = document.createElement("small");
    detail.textContent = sensors;
    words.append(kind, detail);
    label.append(box, words);
    head.append(label);
    return head;
  }

  /** Whether the picture is drawn by it. */
  private shownCell(name: string, refused: string | null, isShown: boolean): HTMLTableCellElement {
    const place = document.createElement("td");
    const radio = document.createElement("input");
    radio.type = "radio";
    radio.name = "shown";
    radio.dataset["focus"] = `use ${name}`;
    radio.checked = isShown;
    radio.disabled = refused !== null;
    radio.setAttribute("aria-label", say("replay.rivals.use", { name: estimatorWords(name).join(", ") }));
    radio.onchange = () => this.use(name);
    const target = document.createElement("label");
    target.append(radio);
    place.append(target);
    return place;
  }
}

function cell(text: string, columns = 1): HTMLTableCellElement {
  const place = document.createElement("td");
  place.textContent = text;
  place.colSpan = columns;
  if (columns > 1) place.className = "why";
  return place;
}
