/**
 * Picture and model as one image: the picture keeps its own pixels, the model is bent by the lens onto them.
 *
 * The model is drawn by an exact pinhole; a mesh over the picture reads that drawing at undistorted places (`lookup.ts`).
 * The picture goes in and comes out as sRGB bytes: neither tone mapping nor colour conversion touches it.
 */

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Mesh,
  NoBlending,
  NoColorSpace,
  NoToneMapping,
  OrthographicCamera,
  Scene,
  ShaderMaterial,
  Texture,
  Vector2,
  Vector3,
  Vector4,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Drawing } from "./drawing";
import type { Matrix4 } from "./frames";
import { type Lens, sameLens } from "./lens";
import { buildLookup, type Lookup } from "./lookup";
import type { Square } from "./model";
import type { Laying } from "./overlay";
import { reachOf } from "./picture";
import type { Effort } from "./quality";
import type { Doubted } from "./soften";
import { drawsInSoftware } from "./software";

const VERTEX = /* glsl */ `
  attribute vec2 place; attribute vec2 drawn; attribute float known;
  uniform vec2 pictureSize; uniform vec2 reach; uniform int quarterTurns;
  varying vec2 vPlace; varying vec2 vDrawn; varying float vKnown;
  void main() {
    vPlace = place / pictureSize; vDrawn = drawn; vKnown = known;
    vec2 p = vec2(2.0 * vPlace.x - 1.0, 1.0 - 2.0 * vPlace.y);
    if (quarterTurns == 1) p = vec2(p.y, -p.x);
    else if (quarterTurns == 2) p = -p;
    else if (quarterTurns == 3) p = vec2(-p.y, p.x);
    gl_Position = vec4(p * reach, 0.0, 1.0);
  }`;

const FRAGMENT = /* glsl */ `
  uniform sampler2D picture; uniform sampler2D drawing; uniform float past; uniform bool hasModel;
  uniform float share; uniform float outline; uniform vec2 texel;
  uniform sampler2D edges; uniform bool isSoft; uniform vec3 gain;
  uniform vec4 window; uniform vec3 upCam; uniform float eyeHeight; uniform float clearTo;
  varying vec2 vPlace; varying vec2 vDrawn; varying float vKnown;
  vec3 toSrgb(vec3 c) {
    c *= gain;
    c = clamp(c / (1.0 + 0.12 * c), 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThan(c, vec3(0.0031308))));
  }
  // 0 where the ground ahead is to be seen, 1 elsewhere: by the way of sight, whatever of the model stands in it
  float kept() {
    if (clearTo <= 0.0) return 1.0;
    vec3 sight = vec3(mix(window.x, window.y, vDrawn.x), mix(window.w, window.z, vDrawn.y), 1.0);
    float up = dot(upCam, sight);
    if (up >= 0.0) return 1.0;
    float away = eyeHeight * sqrt(max(dot(sight, sight) - up * up, 0.0)) / -up;
    return smoothstep(clearTo, 1.6 * clearTo, away);
  }
  vec4 tone(vec2 at) {
    vec4 model = texture2D(drawing, at);
    float solid = step(0.5, model.a); // the ground, thinned, has no outlines: its joints would cover the real one
    return solid * vec4(toSrgb(model.rgb / max(model.a, 0.003)), 1.0);
  }
  float edge() {
    vec4 across = tone(vDrawn + vec2(texel.x, texel.y)) - tone(vDrawn - vec2(texel.x, texel.y));
    vec4 along = tone(vDrawn + vec2(texel.x, -texel.y)) - tone(vDrawn - vec2(texel.x, -texel.y));
    return smoothstep(0.16, 0.5, length(across) + length(along));
  }
  void main() {
    vec3 colour = texture2D(picture, vPlace).rgb;
    if (hasModel && vKnown > 0.999) {
      float left = past * kept();
      if (isSoft) left *= 1.0 - texture2D(edges, vDrawn).r;
      vec4 model = texture2D(drawing, vDrawn);
      if (model.a > 0.003) colour = mix(colour, toSrgb(model.rgb / model.a), clamp(model.a, 0.0, 1.0) * share * left);
      if (outline > 0.0) colour = mix(colour, vec3(0.98, 0.9, 0.72), outline * edge() * left);
    }
    gl_FragColor = vec4(colour, 1.0);
  }`;

export interface Shot {
  readonly bitmap: ImageBitmap;
  readonly lens: Lens;
  readonly quarterTurns: number;
  /** Null: the picture alone. */
  readonly T_site_cam: Matrix4 | null;
  /** How far off that may be: it softens the edges of what hides the model. Null: not at all. */
  readonly doubt: Doubted | null;
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
  private readonly flat = new OrthographicCamera();
  private readonly sheet = new Scene();
  private readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly picture = new Texture();
  private readonly drawing: Drawing;
  private square: Square | null = null;
  private lens: Lens | null = null;
  private lookup: Lookup | null = null;
  private shot: Shot | null = null;
  private softens = true;
  /** How far each eye is to the right of the camera, metres. */
  private asides_m: readonly number[] = [0];
  /** Of the canvas, in pixels of the page. */
  private size: readonly [number, number] = [1, 1];
  private readonly onePixel = new Uint8Array(4);

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: false, powerPreference: "high-performance" });
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.info.autoReset = false;
    this.drawing = new Drawing(this.renderer);
    this.renderer.setClearColor(new Color(0x0b0a08), 1);
    this.picture.colorSpace = NoColorSpace;
    this.picture.flipY = false;
    this.picture.generateMipmaps = false;
    const uniforms = {
      picture: { value: this.picture },
      drawing: { value: this.drawing.target.texture },
      edges: { value: this.drawing.soft.texture },
      isSoft: { value: false },
      gain: { value: new Vector3(1, 1, 1) },
      pictureSize: { value: new Vector2(1, 1) },
      reach: { value: new Vector2(1, 1) },
      quarterTurns: { value: 0 },
      past: { value: 1 },
      hasModel: { value: false },
      share: { value: 1 },
      outline: { value: 0 },
      texel: { value: new Vector2(1, 1) },
      window: { value: new Vector4() },
      upCam: { value: new Vector3() },
      eyeHeight: { value: 1 },
      clearTo: { value: 0 },
    };
    const material = new ShaderMaterial({
      uniforms,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      toneMapped: false,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.sheet.add(this.mesh);
  }

  /** Whether there is no graphics card: then only the coarsest level can keep up with the pictures. */
  get drawsInSoftware(): boolean {
    return drawsInSoftware(this.renderer);
  }

  /** Draw this square from now on. */
  show(square: Square): void {
    this.square = square;
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

  /** Draw one picture with the pose of that picture. */
  draw(shot: Shot): void {
    this.shot = shot;
    this.useLens(shot.lens);
    if (this.picture.image !== shot.bitmap) {
      // a texture of another size cannot take the new picture in place
      if ((this.picture.image as ImageBitmap | null)?.width !== shot.bitmap.width) this.picture.dispose();
      this.picture.image = shot.bitmap;
      this.picture.needsUpdate = true;
    }
    const half_m = (this.apart_m ?? 0) / 2;
    this.asides_m = this.apart_m === null ? [0] : [-half_m, half_m];
    for (const eye of this.asides_m.keys()) this.drawEye(shot, eye);
    this.renderer.setViewport(0, 0, ...this.size);
  }

  /** Draw what one eye sees, on its part of the canvas. */
  private drawEye(shot: Shot, eye: number): void {
    const { renderer, asides_m } = this;
    const [width, height] = [this.size[0] / asides_m.length, this.size[1]];
    const hasModel = this.square !== null && shot.T_site_cam !== null && this.past > 0;
    if (hasModel && this.square && shot.T_site_cam)
      this.drawModel(this.square, shot, shot.T_site_cam, asides_m[eye] ?? 0);
    const { uniforms } = this.mesh.material;
    uniforms["hasModel"] = { value: hasModel };
    uniforms["isSoft"] = { value: hasModel && this.drawing.isSoft };
    uniforms["gain"] = { value: new Vector3(...this.gain) };
    uniforms["past"] = { value: this.past };
    uniforms["quarterTurns"] = { value: shot.quarterTurns };
    if (shot.T_site_cam) this.lay(shot.T_site_cam);
    const [reachX, reachY] = reachOf({ ...shot.lens, quarterTurns: shot.quarterTurns }, width / height);
    uniforms["reach"] = { value: new Vector2(reachX, reachY) };
    renderer.setRenderTarget(null);
    renderer.setViewport(eye * width, 0, width, height);
    renderer.autoClear = eye === 0; // it clears both halves
    renderer.render(this.sheet, this.flat);
    renderer.autoClear = true;
  }

  /** Set what the picture's shader needs to know of `laying`. */
  private lay(T_site_cam: Matrix4): void {
    const { uniforms } = this.mesh.material;
    const { share, outline, clear_m, eye_m } = this.laying;
    uniforms["share"] = { value: share };
    uniforms["outline"] = { value: outline };
    uniforms["texel"] = { value: new Vector2(1.2 / this.drawing.target.width, 1.2 / this.drawing.target.height) };
    const { left, right, top, bottom } = this.lookup?.window ?? { left: 0, right: 0, top: 0, bottom: 0 };
    uniforms["window"] = { value: new Vector4(left, right, top, bottom) };
    const [x = 0, y = 0, z = 0] = T_site_cam.slice(8, 11);
    uniforms["upCam"] = { value: new Vector3(x, y, z) };
    uniforms["eyeHeight"] = { value: eye_m };
    uniforms["clearTo"] = { value: clear_m };
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
    this.picture.needsUpdate = true;
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
    const { uniforms } = this.mesh.material;
    uniforms["reach"] = { value: new Vector2(1, 1) };
    uniforms["quarterTurns"] = { value: 0 };
    this.renderer.setRenderTarget(target);
    this.renderer.render(this.sheet, this.flat);
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

  private drawModel(square: Square, { lens, doubt }: Shot, T_site_cam: Matrix4, aside_m: number): void {
    if (this.lookup)
      this.drawing.render(square, {
        lens,
        window: this.lookup.window,
        T_site_cam,
        doubt: this.softens ? doubt : null,
        aside_m,
        eyes: this.asides_m.length,
      });
  }

  private useLens(lens: Lens): void {
    if (this.lens && sameLens(this.lens, lens)) return;
    this.lens = lens;
    this.lookup = buildLookup(lens);
    this.mesh.geometry.dispose();
    this.mesh.geometry = sheetGeometry(this.lookup);
    this.mesh.material.uniforms["pictureSize"] = { value: new Vector2(lens.width_px, lens.height_px) };
  }
}

function sheetGeometry({ columns, rows, places_px, uv, known }: Lookup): BufferGeometry {
  const geometry = new BufferGeometry();
  const indices: number[] = [];
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const a = row * (columns + 1) + column;
      const c = a + columns + 1;
      indices.push(a, c, a + 1, a + 1, c, c + 1);
    }
  }
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(known.length * 3), 3));
  geometry.setAttribute("place", new BufferAttribute(places_px, 2));
  geometry.setAttribute("drawn", new BufferAttribute(uv, 2));
  geometry.setAttribute("known", new BufferAttribute(known, 1));
  geometry.setIndex(indices);
  return geometry;
}

function flipRows(bytes: Uint8Array, width: number, height: number): Uint8Array {
  const flipped = new Uint8Array(bytes.length);
  for (let row = 0; row < height; row++)
    flipped.set(bytes.subarray(4 * width * (height - 1 - row), 4 * width * (height - row)), 4 * width * row);
  return flipped;
}
