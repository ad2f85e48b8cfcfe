/** The square as it stands and as it stood: its models, loaded when they are wanted, lit and tinted alike, one fading into the other. */

import { Square } from "../model";
import type { Site } from "../site";
import { ANCIENT_YEAR, atSolarHour, sunAt } from "../sun";
import { EPOCHS, type Epoch } from "./first";
import type { Stage } from "./stage";

/** The sun of the slider is that of a day in early summer, whatever the day: 2026-06-10, noon UTC. */
const DAY_S = 1_781_092_800;
const FADE_MS = 1000;

export class Epochs {
  /** How much is shown of AD 150: 0 to 1. */
  share: number;
  /** Called when what is shown has changed. */
  changed: () => void = () => undefined;
  /** Called with how much of a model has come, 0 to 1. */
  come: (share: number) => void = () => undefined;
  private readonly squares = new Map<Epoch, Square>();
  private readonly loading = new Map<Epoch, Promise<Square>>();
  private readonly variants = new Map<string, string>();
  private evidence = false;
  private hour: number | null = null;
  private fade: { readonly from: number; readonly to: number; began_ms: number | null } | null = null;

  constructor(
    private readonly site: Site,
    private readonly stage: Stage,
    epoch: Epoch,
    private readonly isCalm: () => boolean,
  ) {
    this.share = epoch === "roman" ? 1 : 0;
    stage.eachPicture((now_ms) => this.turn(now_ms));
  }

  /** The models that there are. */
  get there(): readonly Epoch[] {
    return EPOCHS.filter((epoch) => epoch in this.site.models);
  }

  /** The one of which most is shown. */
  get epoch(): Epoch {
    return this.share > 0.5 ? "roman" : "today";
  }

  get square(): Square | null {
    return this.squares.get(this.epoch) ?? null;
  }

  /** Whether all levels of what is shown are in. */
  get isWhole(): boolean {
    return this.square?.isWhole === true && this.fade === null;
  }

  get chosen(): ReadonlyMap<string, string> {
    return this.variants;
  }

  get isTinted(): boolean {
    return this.evidence;
  }

  /** The solar hour of the light; null for the model's own light. */
  get solarHour(): number | null {
    return this.hour;
  }

  /** Show so much of AD 150, at once; resolves when it is drawn. */
  async set(share: number): Promise<void> {
    this.fade = null;
    this.share = Math.min(1, Math.max(0, share));
    const wanted = EPOCHS.filter((epoch) => (epoch === "roman" ? this.share > 0 : this.share < 1));
    await Promise.all(wanted.map((epoch) => this.load(epoch)));
    this.show();
  }

  /** Go over to an epoch within a second. */
  async turnTo(epoch: Epoch): Promise<void> {
    const to = epoch === "roman" ? 1 : 0;
    if (this.isCalm() || !this.square) return this.set(to);
    await this.load(epoch);
    this.fade = { from: this.share, to, began_ms: null };
    this.stage.ask();
  }

  /** Tint everything by how well it is known, or no longer. */
  tint(on: boolean): void {
    this.evidence = on;
    for (const square of this.squares.values()) void this.stage.redress(square, () => square.showEvidence(on));
  }

  /** Show another reconstruction of a monument. */
  choose(monument: string, variant: string): void {
    this.variants.set(monument, variant);
    for (const square of this.squares.values()) square.showVariant(monument, variant);
  }

  /** Light it as at that solar hour of a day in early summer. */
  light(hour: number): void {
    this.hour = hour;
    for (const [epoch, square] of this.squares) this.shine(epoch, square);
  }

  private async load(epoch: Epoch): Promise<Square> {
    const under = this.loading.get(epoch) ?? this.fetch(epoch);
    this.loading.set(epoch, under);
    try {
      return await under;
    } catch (error) {
      this.loading.delete(epoch); // so that it can be asked for again
      throw error;
    }
  }

  private async fetch(epoch: Epoch): Promise<Square> {
    const levels = this.site.models[epoch];
    if (!levels) throw new Error(`no model named ${epoch}`);
    const square = await Square.load(levels, 1, (share) => this.come(share));
    for (const { id, defaultVariant } of this.site.monuments) {
      const variant = this.variants.get(id) ?? defaultVariant;
      if (variant !== null) square.showVariant(id, variant);
    }
    square.showEvidence(this.evidence);
    this.squares.set(epoch, square);
    this.shine(epoch, square);
    await this.stage.prepare(square);
    // nothing finer is asked for before there is a picture
    void this.stage.drawn().then(() => square.refine());
    return square;
  }

  private shine(epoch: Epoch, square: Square): void {
    const { origin } = this.site;
    if (this.hour === null || !origin) return;
    const t_s = atSolarHour(DAY_S, origin.lon_deg, this.hour);
    this.stage.shine(square, sunAt(t_s, origin.lat_deg, origin.lon_deg, epoch === "roman" ? ANCIENT_YEAR : null));
  }

  private turn(now_ms: number): boolean {
    const { fade } = this;
    if (!fade) return false;
    fade.began_ms ??= now_ms;
    const way = Math.min(1, (now_ms - fade.began_ms) / FADE_MS);
    this.share = fade.from + (fade.to - fade.from) * way;
    if (way === 1) this.fade = null;
    this.show();
    return way < 1;
  }

  private show(): void {
    const [today, roman] = [this.squares.get("today"), this.squares.get("roman")];
    if (this.share === 1 && roman) this.stage.show(roman);
    else if (this.share === 0 && today) this.stage.show(today);
    else if (today && roman) this.stage.show(today, roman, this.share);
    this.changed();
  }
}
