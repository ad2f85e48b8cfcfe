/** The start page: the square as it stood and as it stands, to turn about and to stand in, and the walks that can be joined. */

import "./everyone";
import { Card } from "./card";
import { canDraw, element, publishNothing, tell } from "./dom";
import { languages, say } from "./language/speech";
import { fillLegend } from "./legend";
import { Square } from "./model";
import { clockText } from "./playback";
import { parseSessions } from "./protocol";
import { type Monument, parseSite, type Site } from "./site";
import { Stage } from "./stage";

const LOOK_AGAIN_MS = 3000;
/** On a narrower screen the panel is folded at first, so that the square is seen. */
const NARROW_PX = 600;
const MODEL_WORDS: Readonly<Record<string, string>> = { roman: "AD 150", today: "Today" };

async function showWalks(): Promise<void> {
  const note = element("walks-note", HTMLElement);
  try {
    const answer = await fetch("/api/sessions");
    element("enter", HTMLElement).hidden = answer.status !== 401;
    const sessions = answer.status === 401 ? [] : parseSessions(await answer.json());
    const links = sessions.map((session) => {
      const link = document.createElement("a");
      link.href =
        session.kind === "replay"
          ? `/replay/${encodeURIComponent(session.name)}`
          : `/ar?session=${encodeURIComponent(session.name)}`;
      const detail = document.createElement("span");
      detail.textContent = session.kind === "replay" ? clockText(session.duration_s) : "live";
      link.append(session.kind === "replay" ? `Replay ${session.log ?? session.name}` : `Join ${session.name}`, detail);
      return link;
    });
    const walks = element("walks", HTMLElement);
    // a list that has not changed stays, and so does the focus on one of its links
    if (links.map((link) => link.outerHTML).join("") !== walks.innerHTML) walks.replaceChildren(...links);
    tell(note, links.length > 0 ? null : "No walk is being shown just now: it appears here when one begins.");
  } catch {
    tell(note, "The server does not answer: trying again …");
  }
  window.setTimeout(() => void showWalks(), LOOK_AGAIN_MS);
}

class Home {
  private readonly stage: Stage;
  private readonly card: Card;
  private readonly byId: ReadonlyMap<string, Monument>;
  private square: Square | null = null;
  private whole = false;
  private model: string;
  private evidence: boolean;

  constructor(
    private readonly site: Site,
    asked: URLSearchParams,
  ) {
    this.card = new Card(site, () => this.square);
    this.byId = new Map(site.monuments.map((monument) => [monument.id, monument]));
    this.stage = new Stage(element("view", HTMLCanvasElement), site.eye_height_m);
    this.model = asked.get("model") ?? "roman";
    this.evidence = asked.get("evidence") === "1";
    element("about", HTMLDetailsElement).open = innerWidth >= NARROW_PX;
    this.offerModels();
    this.offerEvidence();
    this.offerTour(asked.get("view"));
    this.namePointed();
  }

  /** Load and show the chosen model; resolves at its first paint. */
  async load(): Promise<void> {
    const { model } = this;
    const levels = this.site.models[model];
    if (!levels) throw new Error(`no model named ${model}`);
    this.whole = false;
    const square = await Square.load(levels, 1);
    if (model !== this.model) return square.dispose(); // another one was asked for meanwhile
    this.square = square;
    for (const { id, defaultVariant } of this.site.monuments)
      if (defaultVariant !== null) square.showVariant(id, defaultVariant);
    square.showEvidence(this.evidence);
    this.stage.show(square);
    void square.refine().then(() => {
      this.whole = this.square === square;
    });
  }

  get stats(): Readonly<Record<string, unknown>> {
    return { ...this.stage.stats, model: this.model, whole: this.whole && this.stage.isSettled };
  }

  private offerModels(): void {
    const buttons = Object.keys(this.site.models)
      .filter((model) => model in MODEL_WORDS)
      .map((model) => {
        const button = document.createElement("button");
        button.type = "button";
        button.textContent = MODEL_WORDS[model] ?? model;
        button.setAttribute("aria-pressed", String(model === this.model));
        button.onclick = () => {
          if (model === this.model) return;
          this.model = model;
          for (const other of buttons) other.setAttribute("aria-pressed", String(other === button));
          this.card.show(null, null);
          this.load().catch((error: unknown) => complain(error));
        };
        return button;
      });
    const models = element("models", HTMLElement);
    models.replaceChildren(...buttons);
    models.hidden = buttons.length < 2;
  }

  private offerEvidence(): void {
    const box = element("evidence", HTMLInputElement);
    const legend = element("legend", HTMLElement);
    fillLegend(legend, this.site);
    const apply = (): void => {
      this.evidence = box.checked;
      legend.hidden = !box.checked;
      this.square?.showEvidence(box.checked);
    };
    box.checked = this.evidence;
    box.onchange = apply;
    apply();
  }

  private offerTour(asked: string | null): void {
    const menu = element("tour", HTMLSelectElement);
    const { views } = this.site;
    menu.append(...views.map(({ id, name }) => new Option(name, id, false, id === asked)));
    element("places", HTMLElement).hidden = views.length === 0;
    const apply = (): void => {
      const view = views.find(({ id }) => id === menu.value);
      if (view) this.stage.stand(view);
      else this.stage.fly();
      tell(element("guide", HTMLElement), view?.text ?? null);
      element("lead", HTMLElement).hidden = Boolean(view?.text);
    };
    menu.onchange = apply;
    apply();
  }

  /** Name the monument under the pointer; a click or a tap tells of it. */
  private namePointed(): void {
    const canvas = element("view", HTMLCanvasElement);
    const label = element("label", HTMLElement);
    let busy = false;
    const nameAt = (event: MouseEvent): void => {
      if (busy) return;
      busy = true;
      requestAnimationFrame(() => {
        busy = false;
        tell(label, this.byId.get(this.stage.at(event)?.group ?? "")?.name ?? null);
        label.style.left = `${event.clientX}px`;
        label.style.top = `${event.clientY}px`;
      });
    };
    canvas.onpointermove = (event) => {
      if (event.buttons === 0 && event.pointerType === "mouse") nameAt(event);
      else tell(label, null);
    };
    let from: readonly [number, number] = [0, 0];
    canvas.onpointerdown = ({ clientX, clientY }) => {
      from = [clientX, clientY];
    };
    canvas.onclick = (event) => {
      if (Math.hypot(event.clientX - from[0], event.clientY - from[1]) > 6) return; // the end of a drag
      const thing = this.stage.at(event);
      this.card.show(this.byId.get(thing?.group ?? "") ?? null, thing);
    };
    canvas.onpointerleave = () => tell(label, null);
  }
}

function complain(error: unknown): void {
  tell(element("notice", HTMLElement), say("trouble.model"));
  console.warn(error);
}

function start(): void {
  void showWalks();
  if (!canDraw(element("notice", HTMLElement))) {
    publishNothing();
    return;
  }
  let home: Home | null = null;
  const show = async (): Promise<void> => {
    try {
      const site = parseSite(await (await fetch("/api/site")).json(), languages(navigator.languages));
      element("site", HTMLElement).textContent = site.name;
      element("credit", HTMLElement).textContent = site.attribution;
      home = new Home(site, new URLSearchParams(location.search));
      await home.load();
    } catch (error) {
      complain(error);
    }
  };
  publishNothing(show(), () => home?.stats ?? null);
}

start();
