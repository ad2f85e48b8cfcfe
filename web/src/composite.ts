/**
 * Picture and model as one image: the picture keeps its own pixels, the model is bent by the lens onto them.
 *
 * The model is drawn by an exact pinhole; a mesh over the picture reads that drawing at undistorted places (`lookup.ts`).
 * The picture goes in and comes out as sRGB bytes: neither tone mapping nor colour conversion touches it.
 */

import { Color, NoToneMapping, WebGLRenderer, WebGLRenderTarget } from "three";
import type { Picture } from "./decoding";
import { Drawing } from "./drawing";
import type { Matrix4 } from "./frames";
import { type Lens, sameLens } from "./lens";
import { buildLookup, type Lookup } from "./lookup";
import type { Square } from "./model";
import type { Laying } from "./overlay";
import { reachOf } from "./picture";
import type { Effort } from "./quality";
import { Sheet } from "./sheet";
import type { Doubted } from "./soften";
import { anisotropyFor, drawsInSoftware } from "./software";

/** From where the model is drawn. */
export interface View {
  readonly lens: Lens;
  /** Null: the picture alone. */
  readonly T_site_cam: Matrix4 | null;
  /** How far off that may be: it softens the edges of what hides the model. Null: not at all. */
  readonly doubt: Doubted | null;
}

export interface Shot extends View {
  readonly picture: Picture;
  readonly quarterTurns: number;
}

const SOLID: Laying = { share: 1, outline: 0, clear_m: 0, eye_m: 1.65 };

export class Composite {
  readonly renderer: WebGLRenderer;
  /** How much of the past is shown, 0 to 1. */
  past = 0.85;
  /** How far the eyes are apart, metres, for a picture of each side by side; null for one picture. */
  apart_m: number | null = null;
  /** What the model's linear colours are multiplied by, to be as bright as the picture. */
  gain: readonly [number, number, number] = [1, 1, 1];
  /** How the model is laid over the next picture. */
  laying: Laying = SOLID;
  private readonly anisotropy: number;
  private readonly drawing: Drawing;
  private readonly sheet: Sheet;
  private square: Square | null = null;
  private lens: Lens | null = null;
  private lookup: Lookup | null = null;
  private shot: Shot | null = null;
  /** Of which view the model was drawn last, if nothing has been drawn with it yet. */
  private ahead: Matrix4 | null = null;
  private softens = true;
  /** How far each eye is to the right of the camera, metres. */
  private asides_m: readonly number[] = [0];
  /** Of the canvas, in pixels of the page. */
  private size: readonly [number, number] = [1, 1];
  private readonly onePixel = new Uint8Array(4);

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({
      canvas,
      antialias: false,
      alpha: false,
      depth: false, // what has depth is drawn elsewhere
      powerPreference: "high-performance",
    });
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.info.autoReset = false;
    this.anisotropy = anisotropyFor(this.renderer);
    this.drawing = new Drawing(this.renderer);
    this.sheet = new Sheet(this.drawing);
    this.renderer.setClearColor(new Color(0x0b0a08), 1);
  }

  /** Whether there is no graphics card: then only the coarsest level can keep up with the pictures. */
  get drawsInSoftware(): boolean {
    return drawsInSoftware(this.renderer);
  }

  /** Draw this square from now on. */
  show(square: Square): void {
    this.square = square;
    square.anisotropy = this.anisotropy;
    square.changed = () => {
      this.renderer.shadowMap.needsUpdate = true;
      this.redraw();
    };
    square.changed();
  }

  /** Fit the canvas to its place on the page. */
  resize(width: number, height: number, pixelRatio: number): void {
    this.size = [width, height];
    this.renderer.setPixelRatio(Math.min(pixelRatio, 2));
    this.renderer.setSize(width, height, false);
    if (this.shot) this.draw(this.shot);
  }

  /** Draw the model alone, for a picture that is still being decoded: `draw` with the same place lays it over that. */
  drawAhead(view: View): void {
    this.part();
    if (this.asides_m.length > 1) return;
    this.useLens(view.lens);
    if (!this.drawModel(view, 0)) return;
    this.ahead = view.T_site_cam;
    this.renderer.getContext().flush(); // so that it begins now
  }

  /** Draw one picture with the pose of that picture. */
  draw(shot: Shot): void {
    this.shot = shot;
    this.useLens(shot.lens);
    this.sheet.show(shot.picture);
    this.part();
    for (const eye of this.asides_m.keys()) this.drawEye(shot, eye);
    this.renderer.setViewport(0, 0, ...this.size);
  }

  /** Set where the eyes are. */
  private part(): void {
    const half_m = (this.apart_m ?? 0) / 2;
    this.asides_m = this.apart_m === null ? [0] : [-half_m, half_m];
  }

  /** Draw what one eye sees, on its part of the canvas. */
  private drawEye(shot: Shot, eye: number): void {
    const { renderer, asides_m } = this;
    const [width, height] = [this.size[0] / asides_m.length, this.size[1]];
    const { T_site_cam } = shot;
    const isDrawn = (T_site_cam !== null && this.ahead === T_site_cam) || this.drawModel(shot, asides_m[eye] ?? 0);
    this.ahead = null;
    const { past, gain, laying } = this;
    this.sheet.cover(isDrawn && T_site_cam ? { isSoft: this.drawing.isSoft, past, gain, laying, T_site_cam } : null);
    renderer.setRenderTarget(null);
    renderer.setViewport(eye * width, 0, width, height);
    renderer.autoClear = eye === 0; // it clears both halves
    const reach = reachOf({ ...shot.lens, quarterTurns: shot.quarterTurns }, width / height);
    this.sheet.render(renderer, reach, shot.quarterTurns);
    renderer.autoClear = true;
  }

  /** Draw with this much effort from now on. */
  work({ fineness, samples, soft }: Effort): void {
    this.drawing.fineness = fineness;
    this.drawing.samples = samples;
    this.softens = soft;
  }

  /** Wait until the last pixel is drawn. */
  finish(): void {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, this.onePixel);
  }

  /** Draw the present picture with another pose, until the next one: null for its own. */
  preview(T_site_cam: Matrix4 | null): void {
    const { shot } = this;
    if (!shot) return;
    this.draw(T_site_cam === null ? shot : { ...shot, T_site_cam });
    this.shot = shot;
  }

  /** Draw again, once the browser has given the graphics back. */
  begin(): void {
    this.renderer.shadowMap.needsUpdate = true;
    this.sheet.resend();
    this.redraw();
  }

  /** Draw again, after something other than the picture has changed. */
  redraw(): void {
    if (this.shot) this.draw(this.shot);
  }

  /** Draw small squares of colour at points of the gltf world, over everything or where they are not hidden: for tests. */
  mark(
    points_gltf: readonly (readonly [number, number, number])[],
    colours: readonly string[],
    hideable = false,
  ): void {
    if (this.square) this.drawing.mark(this.square, points_gltf, colours, hideable);
  }

  /** Return RGBA bytes of a rectangle of the composite in pixels of the stored picture, top row first. */
  read(x: number, y: number, width: number, height: number): Uint8Array {
    const shot = this.shot;
    if (!shot) return new Uint8Array();
    const target = new WebGLRenderTarget(shot.lens.width_px, shot.lens.height_px);
    this.renderer.setRenderTarget(target);
    this.sheet.render(this.renderer, [1, 1], 0);
    const bytes = new Uint8Array(4 * width * height);
    this.renderer.readRenderTargetPixels(target, x, shot.lens.height_px - y - height, width, height, bytes);
    this.renderer.setRenderTarget(null);
    target.dispose();
    return flipRows(bytes, width, height);
  }

  /** What the last model drawing cost. */
  get cost(): { readonly calls: number; readonly triangles: number } {
    return this.drawing.cost;
  }

  /** Draw the model for one eye; return whether there is anything to draw. */
  private drawModel({ lens, T_site_cam, doubt }: View, aside_m: number): boolean {
    const { square, lookup } = this;
    if (!square || !lookup || !T_site_cam || this.past <= 0) return false;
    this.drawing.render(square, {
      lens,
      window: lookup.window,
      T_site_cam,
      doubt: this.softens ? doubt : null,
      aside_m,
      eyes: this.asides_m.length,
    });
    return true;
  }

  private useLens(lens: Lens): void {
    if (this.lens && sameLens(this.lens, lens)) return;
    this.lens = lens;
    this.lookup = buildLookup(lens);
    this.sheet.bend(this.lookup, [lens.width_px, lens.height_px]);
  }
}

function flipRows(bytes: Uint8Array, width: number, height: number): Uint8Array {
  const flipped = new Uint8Array(bytes.length);
  for (let row = 0; row < height; row++)
    flipped.set(bytes.subarray(4 * width * (height - 1 - row), 4 * width * (height - row)), 4 * width * row);
  return flipped;
}
