/** The square as it is drawn on the start page, when something asks for it. three.js only. */

import { ACESFilmicToneMapping, Fog, type Group, PerspectiveCamera, type Texture, WebGLRenderer } from "three";
import type { Standpoint } from "../describe";
import type { Vector3 } from "../frames";
import type { Square } from "../model";
import { COARSEST } from "../quality";
import { Readying } from "../readying";
import { Sky } from "../sky";
import { anisotropyFor, drawsInSoftware } from "../software";
import type { Sun } from "../sun";
import type { Thing } from "../thing";
import { Controls } from "./controls";
import { Explorer } from "./explorer";
import type { Eye } from "./eye";
import { BEST, breakAfter, Pace, type Step } from "./pace";
import { type Layer, Painting } from "./painting";
import { Rays } from "./rays";
import type { Leader, Turn, World } from "./world";

/** `assets/levels.py` tells costs for this field of view. */
const FIELD_DEG = 46.7;
/** On a screen held upright the field of view grows upwards, so that at least this much is seen across. */
const LEAST_WIDTH_DEG = 38;
const FOG_M = [220, 900] as const;
const FINEST = 2;
/** So long after the last motion the finest picture is drawn. */
const REST_MS = 180;

export class Stage implements World {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(FIELD_DEG, 1, 0.15, 1500);
  readonly explorer: Explorer;
  private readonly rays: Rays;
  private readonly layers = new Map<Square, Layer>();
  private readonly turns = new Set<Turn>();
  private readonly painting: Painting;
  private readonly readying: Readying;
  private readonly pace: Pace;
  private readonly inSoftware: boolean;
  private readonly anisotropy: number;
  private below: Layer | null = null;
  private above: Layer | null = null;
  private share = 0;
  private fades = false;
  /** Whether the next turn is under way, and whether it must end in a picture. */
  private asked = false;
  private wanted = false;
  private guestsMove = false;
  /** Whether the last picture was another view than the one before. */
  private moves = false;
  /** When who moves was drawn alone, until the next picture's turn; and when they are to be drawn again. */
  private guestsDrawn_ms: number | null = null;
  private guestsDue_ms = Number.NEGATIVE_INFINITY;
  private fineness = 1;
  private isDressing = false;
  private compiling = 0;
  private resting: number | null = null;
  private moved_ms = Number.NEGATIVE_INFINITY;
  private drawn_ms: number | null = null;
  private pictures = 0;
  private readonly waiting: (() => void)[] = [];
  /** Called when a square has changed: a finer ground may be a little higher. */
  refined: () => void = () => undefined;

  constructor(
    readonly canvas: HTMLCanvasElement,
    stick: HTMLElement,
    eyeHeight_m: number,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.info.autoReset = false;
    this.renderer.autoClear = false;
    this.renderer.debug.checkShaderErrors = import.meta.env.DEV; // to ask for errors waits for the compiler
    this.inSoftware = drawsInSoftware(this.renderer);
    this.anisotropy = anisotropyFor(this.renderer); // to ask later would wait for all that is being drawn
    this.pace = new Pace(this.inSoftware);
    this.readying = new Readying(this.renderer);
    this.painting = new Painting(this.renderer, this.camera);
    this.rays = new Rays(this.camera, canvas);
    // blurring what is behind the panels costs as much as drawing the model
    document.body.classList.toggle("frugal", this.inSoftware);
    this.explorer = new Explorer(this.camera, canvas, new Controls(canvas, stick), eyeHeight_m, () => this.ask());
    new ResizeObserver(() => this.fill()).observe(canvas);
    this.fill();
  }

  /** What the last drawing cost, shadows left out, and what the renderer holds. */
  get stats(): Readonly<Record<string, number>> {
    const { pictures, fineness } = this;
    const { cost } = this.painting;
    const { geometries, textures } = this.renderer.info.memory;
    return { drawCalls: cost.calls, triangles: cost.triangles, framesDrawn: pictures, fineness, geometries, textures };
  }

  /** Whether all that was asked for is drawn, as finely as it can be; who is led by what moves has no more to wait for. */
  get isSettled(): boolean {
    return (
      ((this.guestsMove && this.moves) || (!this.wanted && this.resting === null && this.compiling === 0)) &&
      !this.explorer.isFlying
    );
  }

  get eye(): Eye {
    return this.explorer.eye;
  }

  /** Where the eye is and how much it sees from side to side. */
  get standpoint(): Standpoint {
    const { place_site_m, heading_rad } = this.eye;
    const [e_m, n_m, u_m] = place_site_m;
    const half_rad = Math.atan(Math.tan((this.camera.fov * Math.PI) / 360) * this.camera.aspect);
    return { e_m, n_m, u_m, heading_rad, half_rad };
  }

  /** Resolves when a square can be drawn without a halt. */
  async prepare(square: Square): Promise<void> {
    const layer = this.layer(square);
    const { plain } = this.pace.step;
    if (layer.plain !== plain) this.dress(layer, plain);
    await this.compile(layer);
  }

  /** Draw this square, and over it, by that share, another one: from one time to the other. */
  show(below: Square, above: Square | null = null, share = 0): void {
    this.below = this.layer(below);
    this.above = above && share > 0 ? this.layer(above) : null;
    this.fades ||= share !== this.share;
    this.share = share;
    this.renew();
  }

  get guests(): Group {
    return this.painting.guests.group;
  }

  /** Change how a square is drawn, and draw it so when that can be done without a halt. */
  async redress(square: Square, change: () => void): Promise<void> {
    const layer = this.layer(square);
    this.isDressing = true;
    change();
    this.isDressing = false;
    this.compiling += 1;
    await this.compileBoth(layer);
    this.compiling -= 1;
    this.renew();
  }

  /** Light a square by a sun at this place of the sky. */
  shine(square: Square, sun: Sun): void {
    const { sky } = this.layer(square);
    sky.shine(sun);
    this.painting.guests.light.shine(sun);
    square.shine(sun);
  }

  /** Forget a square that is shown no longer. */
  drop(square: Square): void {
    const layer = this.layers.get(square);
    this.layers.delete(square);
    layer?.sky.dispose();
    square.dispose();
  }

  go(eye: Eye): void {
    this.explorer.go(eye, "fly");
  }

  lead(leader: Leader | null, released?: () => void): void {
    this.explorer.lead(leader, released);
  }

  eachPicture(turn: Turn): () => void {
    this.turns.add(turn);
    this.ask();
    return () => this.turns.delete(turn);
  }

  ask(): void {
    this.wanted = true;
    this.look();
  }

  /** Ask for a picture of what has changed itself, not only what moves in it. */
  private renew(): void {
    this.painting.forget();
    this.ask();
  }

  look(): void {
    if (this.asked) return;
    requestAnimationFrame((now_ms) => this.turn(now_ms));
    this.asked = true;
  }

  /** Draw, unless it is the others' turn and nothing was asked for. */
  private turn(now_ms: number): void {
    this.asked = false;
    if (this.guestsDrawn_ms !== null) {
      // this picture's own turn came when the last one was on its way to the screen
      const took_ms = now_ms - this.guestsDrawn_ms;
      this.guestsDue_ms = now_ms + breakAfter(took_ms, this.isReady());
      this.guestsDrawn_ms = null;
    }
    if (this.wanted || now_ms >= this.guestsDue_ms) this.draw(now_ms);
    else this.look();
  }

  reach(from: Vector3, to: Vector3): number {
    return this.front ? this.rays.reach(this.front, from, to) : Number.POSITIVE_INFINITY;
  }

  /** Return what is drawn at a point of the window. */
  at(point: { readonly clientX: number; readonly clientY: number }): Thing | null {
    return this.front?.find(this.rays.through(point)) ?? null;
  }

  /** Return the place that is drawn at a point of the window; null for the sky. */
  placeAt(point: { readonly clientX: number; readonly clientY: number }): Vector3 | null {
    const hit = this.front?.hit(this.rays.through(point));
    return hit ? [hit.x, -hit.z, hit.y] : null;
  }

  /** Return the point of the window where a place is drawn, pixels; null where it lies behind. */
  pointOf(place_site_m: Vector3): readonly [number, number] | null {
    return this.rays.pointOf(place_site_m);
  }

  /** Return the height of the drawn ground at a place of the plan; null where there is none. */
  groundAt(e_m: number, n_m: number): number | null {
    return this.front?.groundAt(e_m, -n_m, this.rays.caster) ?? null;
  }

  /** Resolve when something has been drawn. */
  drawn(): Promise<void> {
    return this.pictures > 0 ? Promise.resolve() : this.next();
  }

  /** Draw, and resolve when that is done. */
  private next(): Promise<void> {
    this.renew();
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  /** Draw now, at its finest, and return a copy. */
  picture(): HTMLCanvasElement {
    this.take(BEST);
    this.render();
    const { width, height } = this.canvas;
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [width, height];
    copy.getContext("2d")?.drawImage(this.canvas, 0, 0);
    return copy;
  }

  /** Let what has come in go to the graphics card by and by; without one, nobody waits for each picture. */
  private async pause(layer: Layer, pictures: readonly Texture[]): Promise<void> {
    for (const picture of pictures) {
      await this.readying.idle();
      this.renderer.initTexture(picture);
    }
    this.moved_ms = performance.now();
    if (!layer.plain) await this.compile(layer);
    await (this.inSoftware ? this.readying.drained() : this.next());
  }

  private get front(): Square | null {
    return (this.above && this.share > 0.5 ? this.above : this.below)?.square ?? null;
  }

  private layer(square: Square): Layer {
    const known = this.layers.get(square);
    if (known) return known;
    const layer: Layer = { square, sky: new Sky(), stale: true, thrown: false, plain: false, finest: "no" };
    this.layers.set(square, layer);
    this.moved_ms = performance.now(); // a first picture that is there soon, then the finest
    square.scene.add(layer.sky.mesh);
    square.scene.fog = new Fog(0, ...FOG_M);
    (square.scene.fog as Fog).color = layer.sky.horizon;
    square.anisotropy = this.anisotropy;
    square.pause = (pictures) => this.pause(layer, pictures);
    square.changed = () => {
      if (this.isDressing) return;
      layer.stale = true;
      this.refined();
      this.renew();
    };
    return layer;
  }

  private fill(): void {
    const { canvas, camera } = this;
    camera.aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight);
    camera.fov = fieldOf(camera.aspect);
    camera.updateProjectionMatrix();
    this.resize();
    this.renew();
  }

  private resize(): void {
    const { renderer, canvas } = this;
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, FINEST));
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
  }

  /**
   * Draw into a corner of the canvas and enlarge that: to make the canvas itself smaller would wait for all that is being drawn.
   */
  private fit(fineness: number): void {
    const { renderer, canvas } = this;
    renderer.setViewport(0, 0, canvas.clientWidth * fineness, canvas.clientHeight * fineness);
    canvas.style.transform = fineness === 1 ? "" : `scale(${1 / fineness})`;
  }

  private draw(now_ms: number): void {
    const isWanted = this.wanted;
    this.wanted = false;
    const before = this.camera.matrixWorld.clone();
    const goesOn = this.explorer.turn(now_ms);
    this.guestsMove = false;
    for (const turn of this.turns) this.guestsMove = turn(now_ms) || this.guestsMove;
    if (!this.below) return;
    this.camera.updateMatrixWorld();
    this.moves = !this.camera.matrixWorld.equals(before) || this.fades;
    this.fades = false;
    if (this.moves) {
      if (this.drawn_ms !== null) this.pace.drawn(now_ms - this.drawn_ms, now_ms);
      this.moved_ms = now_ms;
      this.painting.forget();
    }
    this.drawn_ms = this.moves ? now_ms : null;
    if (!isWanted && !this.moves && !this.guestsMove && !goesOn) return;
    const isReady = this.isReady();
    const rests = this.pace.step === BEST || (isReady && now_ms - this.moved_ms >= REST_MS && this.isFinest());
    this.take(rests ? BEST : this.pace.step);
    this.render();
    if (!rests && isReady && this.compiling === 0) this.restLater();
    if (goesOn) this.ask();
    else if (this.guestsMove) this.look();
    this.guestsDrawn_ms = this.inSoftware && this.guestsMove && !this.moves ? now_ms : null;
  }

  /** Draw by that step from now on. */
  private take(step: Step): void {
    if (step.fineness !== this.fineness || step.plain !== this.painting.isHurried) this.painting.forget();
    this.fit(step.fineness);
    this.fineness = step.fineness;
    this.painting.isHurried = step.plain;
    for (const layer of this.layers.values()) {
      if (layer.plain === step.plain) continue;
      this.dress(layer, step.plain);
      layer.stale ||= !step.plain;
    }
  }

  /** Whether it is time for the finest picture: without a graphics card everything that comes in would wait for it. */
  private isReady(): boolean {
    return !this.inSoftware || [this.below, this.above].every((layer) => layer === null || layer.square.isWhole);
  }

  /** Whether the finest surfaces can be drawn at once; where not, begin to compile them, and ask again when that is done. */
  private isFinest(): boolean {
    const layers = [this.below, this.above].filter((layer) => layer !== null);
    for (const layer of layers.filter(({ finest }) => finest === "no")) {
      layer.finest = "soon";
      this.compiling += 1;
      void this.compileBoth(layer).then(() => {
        layer.finest = "yes";
        this.compiling -= 1;
        this.ask();
      });
    }
    return layers.every(({ finest }) => finest === "yes");
  }

  /** Compile it as it is drawn while something moves, and as it rests. */
  private async compileBoth(layer: Layer): Promise<void> {
    const { plain } = layer;
    const asNow = this.compile(layer);
    this.dress(layer, !plain);
    const asElse = this.compile(layer);
    this.dress(layer, plain);
    await Promise.all([asNow, asElse]);
  }

  /** Compile it as it is dressed now. */
  private compile({ square }: Layer): Promise<void> {
    return this.readying.compile(square.scene, this.camera);
  }

  private dress(layer: Layer, plain: boolean): void {
    layer.plain = plain;
    this.isDressing = true;
    layer.square.work({ plain, finest: plain ? COARSEST : 0, shadows: true, occluders: true, landscape: true });
    this.isDressing = false;
  }

  private restLater(): void {
    if (this.resting !== null) window.clearTimeout(this.resting);
    this.resting = window.setTimeout(() => {
      this.resting = null;
      this.ask();
    }, REST_MS + 20);
  }

  private render(): void {
    const { below, above, share, painting } = this;
    if (!below) return;
    if (!above) painting.drawOne(below, this.guestsMove && !this.moves);
    else if (share > 0.5) painting.drawBoth(above, below, 1 - share, this.fineness);
    else painting.drawBoth(below, above, share, this.fineness);
    if (this.pictures === 0) void painting.ready(this.readying);
    this.pictures += 1;
    for (const drawn of this.waiting.splice(0)) drawn();
  }
}

/** Return the vertical field of view, degrees, that shows enough of the width on a screen of this shape. */
function fieldOf(aspect: number): number {
  const halfWidth = Math.tan((LEAST_WIDTH_DEG * Math.PI) / 360);
  return Math.max(FIELD_DEG, (Math.atan(halfWidth / aspect) * 360) / Math.PI);
}
