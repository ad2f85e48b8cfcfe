/** Beside the walkers: everybody who walks now is shown in the square, can be followed, and is told who else looks on. */

import { Group } from "three";
import type { Directory } from "../browse/directory";
import { poseOf } from "../browse/eye";
import type { World } from "../browse/world";
import type { Vector3 } from "../frames";
import type { Session } from "../protocol";
import { Escort, type Way } from "./gaze";
import { Glide } from "./glide";
import { Guest } from "./guest";
import { Looks } from "./looks";
import { Others } from "./others";
import { Panel } from "./panel";

/** The newest walks: more would need more connections than a phone should hold. */
const MOST_WALKS = 6;
/** So often it is looked whether nothing comes any more. */
const LOOKED_EVERY_MS = 1000;

export class Beside {
  private readonly guests = new Map<string, Guest>();
  private readonly place = new Group();
  private readonly others = new Others();
  private readonly glide = new Glide();
  private readonly looks = new Looks();
  private readonly panel: Panel;
  private escort: { readonly name: string; readonly escort: Escort } | null = null;
  private posesDrawn = 0;
  private picture = { picture_ms: Number.NaN, now_ms: 0 };
  /** With whom one is: whose other viewers are shown, and are shown where this one looks from. */
  private mine: Guest | null = null;

  constructor(
    private readonly world: World,
    private readonly eyeHeight_m: number,
    directory: Directory,
  ) {
    this.place.add(this.others.group);
    world.guests.add(this.place);
    this.panel = new Panel({
      go: (name, way) => this.go(name, way),
      leave: () => this.leave(),
      showing: () => this.tellLook(null),
    });
    world.eachPicture((picture_ms) => this.turn(picture_ms));
    window.setInterval(() => world.look(), LOOKED_EVERY_MS);
    document.addEventListener("visibilitychange", () => this.tellLook(document.hidden ? null : undefined));
    directory.listen((found) => {
      // without a server who is shown stays, and says of itself that nothing comes
      if (found !== "no server") this.take(found === "hidden" ? [] : found);
    });
  }

  /** Of the walker that one is with, as `agora.stats()` gives it. */
  get stats(): Readonly<Record<string, unknown>> {
    const { mine } = this;
    return {
      posesDrawn: this.posesDrawn,
      poseAgeMs: mine?.shown?.age_ms ?? null,
      motionModel: mine?.shown?.told.motionModel ?? null,
      estimator: mine?.walk.session.estimator ?? null,
      walkers: [...this.guests.values()].filter(({ shown }) => shown !== null).length,
      watching: mine?.walk.watching ?? null,
      seen: mine?.walk.others.length ?? 0,
    };
  }

  /** Return everybody as drawn in the last picture. */
  get walkers(): readonly Readonly<Record<string, unknown>>[] {
    return [...this.guests.values()].flatMap(({ walk, shown }) =>
      shown === null
        ? []
        : [
            {
              name: walk.name,
              place_site_m: shown.p_site_body_m,
              wxyz_site_body: shown.wxyz_site_body,
              t_ns: shown.t_ns,
              age_ms: shown.age_ms,
              motionModel: shown.told.motionModel,
            },
          ],
    );
  }

  private take(sessions: readonly Session[]): void {
    const there = sessions.filter(({ connected }) => connected).slice(-MOST_WALKS);
    for (const [name, guest] of this.guests) {
      if (there.some((session) => session.name === name)) continue;
      if (this.escort?.name === name) this.leave();
      guest.close();
      this.guests.delete(name);
    }
    for (const session of there)
      if (!this.guests.has(session.name))
        this.guests.set(
          session.name,
          new Guest(
            session,
            this.eyeHeight_m,
            this.place,
            () => this.world.look(),
            () => {
              this.tell();
              this.world.ask();
            },
          ),
        );
    this.settle();
  }

  /** Choose with whom one is: who is followed, else the newest. */
  private settle(): void {
    const chosen = (this.escort && this.guests.get(this.escort.name)) ?? [...this.guests.values()].at(-1) ?? null;
    if (chosen !== this.mine) {
      this.tellLook(null);
      this.mine = chosen;
      this.looks.forget();
    }
    this.tell();
    this.world.ask();
  }

  private go(name: string, way: Way): void {
    const guest = this.guests.get(name);
    if (!guest) return;
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const reach = (from: Vector3, to: Vector3): number => this.world.reach(from, to);
    const escort = new Escort(way, this.world.eye, performance.now(), isStill, reach);
    const lead = (picture_ms: number) => {
      const now_ms = this.now(picture_ms);
      const walker = guest.at(now_ms);
      return walker && poseOf(escort.at(walker, now_ms));
    };
    this.world.lead(lead, () => {
      if (this.escort?.escort !== escort) return;
      this.escort = null;
      this.settle();
    });
    this.escort = { name, escort };
    this.settle();
  }

  private leave(): void {
    this.escort = null;
    this.world.lead(null);
    this.settle();
  }

  /** Return the time at which a picture is drawn, the same for all of it: its own may be tens of milliseconds ago. */
  private now(picture_ms: number): number {
    if (this.picture.picture_ms !== picture_ms) this.picture = { picture_ms, now_ms: performance.now() };
    return this.picture.now_ms;
  }

  private turn(picture_ms: number): boolean {
    const now_ms = this.now(picture_ms);
    let moving = false;
    for (const [name, guest] of this.guests) {
      const isSelf = this.escort?.name === name && this.escort.escort.way === "eyes";
      const isNew = guest.turn(now_ms, isSelf && this.escort?.escort.isThere(now_ms) ? null : this.world.eye);
      if (isNew && guest === this.mine) this.posesDrawn += 1;
      moving ||= guest.moves;
    }
    const seen = this.mine?.walk.others ?? [];
    this.others.show(this.glide.at(seen, now_ms));
    this.panel.turn([...this.guests.values()], now_ms);
    // who looks out of a walker's eyes is nowhere else
    const eye = this.world.eye;
    if (this.escort?.escort.way !== "eyes" && this.panel.isShowing && this.looks.isDue(eye, now_ms))
      this.mine?.walk.look(eye);
    return moving || this.escort?.escort.isAtRest === false || !this.glide.isAtRest(seen);
  }

  private tell(): void {
    this.panel.show(
      [...this.guests.values()],
      this.escort && { name: this.escort.name, way: this.escort.escort.way },
      this.mine,
    );
  }

  private tellLook(eye: null | undefined): void {
    this.looks.forget();
    if (eye === null) this.mine?.walk.look(null);
    this.world.ask();
  }
}
