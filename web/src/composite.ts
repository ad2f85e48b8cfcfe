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
  HalfFloatType,
  Mesh,
  NoBlending,
  NoColorSpace,
  NoToneMapping,
  OrthographicCamera,
  PerspectiveCamera,
  Points,
  PointsMaterial,
  Scene,
  ShaderMaterial,
  Texture,
  Vector2,
  Vector3,
  WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { type Matrix4, viewFromCam } from "./frames";
import { type Lens, sameLens } from "./lens";
import { buildLookup, drawingSize, type Lookup } from "./lookup";
import type { Square } from "./model";

const NEAR_M = 0.1;
const FAR_M = 900;
const LARGEST_DRAWING_PX = 3072;
const TARGET_PX = 7;

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
  varying vec2 vPlace; varying vec2 vDrawn; varying float vKnown;
  vec3 toSrgb(vec3 c) {
    c = clamp(c / (1.0 + 0.12 * c), 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThan(c, vec3(0.0031308))));
  }
  void main() {
    vec3 colour = texture2D(picture, vPlace).rgb;
    if (hasModel && vKnown > 0.999) {
      vec4 model = texture2D(drawing, vDrawn);
      if (model.a > 0.003) colour = mix(colour, toSrgb(model.rgb / model.a), clamp(model.a, 0.0, 1.0) * past);
    }
    gl_FragColor = vec4(colour, 1.0);
  }`;

export interface Shot {
  readonly bitmap: ImageBitmap;
  readonly lens: Lens;
  readonly quarterTurns: number;
  /** Null: the picture alone. */
  readonly T_site_cam: Matrix4 | null;
}

export class Composite {
  readonly renderer: WebGLRenderer;
  /** How much of the past is shown, 0 to 1. */
  past = 0.85;
  private readonly camera = new PerspectiveCamera();
  private readonly flat = new OrthographicCamera();
  private readonly sheet = new Scene();
  private readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly picture = new Texture();
  private readonly drawing = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples: 4 });
  private square: Square | null = null;
  private lens: Lens | null = null;
  private lookup: Lookup | null = null;
  private points: Points<BufferGeometry, PointsMaterial> | null = null;
  private shot: Shot | null = null;
  private model = { calls: 0, triangles: 0 };
  private readonly eye = new Vector3();

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: false, alpha: false, powerPreference: "high-performance" });
    this.renderer.toneMapping = NoToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.info.autoReset = false;
    this.renderer.setClearColor(new Color(0x0b0a08), 1);
    this.picture.colorSpace = NoColorSpace;
    this.picture.flipY = false;
    this.picture.generateMipmaps = false;
    const uniforms = {
      picture: { value: this.picture },
      drawing: { value: this.drawing.texture },
      pictureSize: { value: new Vector2(1, 1) },
      reach: { value: new Vector2(1, 1) },
      quarterTurns: { value: 0 },
      past: { value: 1 },
      hasModel: { value: false },
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
    this.camera.matrixAutoUpdate = false;
  }

  /** Whether there is no graphics card: then only the coarsest level can keep up with the pictures. */
  get drawsInSoftware(): boolean {
    const gl = this.renderer.getContext();
    const named = gl.getExtension("WEBGL_debug_renderer_info");
    return /swiftshader|llvmpipe|software|basic render/i.test(
      String(gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER)),
    );
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
    const hasModel = this.square !== null && shot.T_site_cam !== null && this.past > 0;
    this.renderer.info.reset();
    if (hasModel && this.square && shot.T_site_cam) this.drawModel(this.square, shot.T_site_cam);
    const { uniforms } = this.mesh.material;
    uniforms["hasModel"] = { value: hasModel };
    uniforms["past"] = { value: this.past };
    uniforms["quarterTurns"] = { value: shot.quarterTurns };
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    const [reachX, reachY] = reachOf(shot, size.x / size.y);
    uniforms["reach"] = { value: new Vector2(reachX, reachY) };
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.sheet, this.flat);
  }

  /** Draw again, after something other than the picture has changed. */
  redraw(): void {
    if (this.shot) this.draw(this.shot);
  }

  /** Draw small squares of colour at points of the gltf world, over everything: for tests of where the page draws. */
  mark(points_gltf: readonly (readonly [number, number, number])[], colours: readonly string[]): void {
    if (!this.square) return;
    if (this.points) this.square.scene.remove(this.points);
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(points_gltf.flat()), 3));
    const rgb = colours.flatMap((colour) => new Color(colour).toArray());
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(rgb), 3));
    const material = new PointsMaterial({
      vertexColors: true,
      sizeAttenuation: false,
      depthTest: false,
      toneMapped: false,
    });
    this.points = new Points(geometry, material);
    this.points.renderOrder = 1000;
    this.points.frustumCulled = false;
    this.square.scene.add(this.points);
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
    return this.model;
  }

  private drawModel(square: Square, T_site_cam: Matrix4): void {
    const lookup = this.lookup;
    if (!lookup || !this.lens) return;
    const { left, right, top, bottom } = lookup.window;
    const size = this.renderer.getDrawingBufferSize(new Vector2());
    const scale = Math.max(0.5, Math.min(size.x / this.lens.width_px, size.y / this.lens.height_px));
    const [width, height] = drawingSize(this.lens, lookup.window, scale, LARGEST_DRAWING_PX);
    if (this.drawing.width !== width || this.drawing.height !== height) this.drawing.setSize(width, height);
    if (this.points) this.points.material.size = TARGET_PX * (width / ((right - left) * this.lens.fx_px));
    this.camera.projectionMatrix.makePerspective(
      left * NEAR_M,
      right * NEAR_M,
      -top * NEAR_M,
      -bottom * NEAR_M,
      NEAR_M,
      FAR_M,
      this.camera.coordinateSystem,
    );
    this.camera.projectionMatrixInverse.copy(this.camera.projectionMatrix).invert();
    const view = viewFromCam(T_site_cam);
    this.camera.matrix.fromArray(view as number[]).transpose();
    this.camera.updateMatrixWorld(true);
    if (square.update(this.eye.setFromMatrixPosition(this.camera.matrixWorld)))
      this.renderer.shadowMap.needsUpdate = true;
    this.renderer.setRenderTarget(this.drawing);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    this.renderer.render(square.scene, this.camera);
    this.renderer.setClearColor(new Color(0x0b0a08), 1);
    const { calls, triangles } = this.renderer.info.render;
    this.model = { calls, triangles };
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

/** Return how far the picture reaches in the canvas, -1 to 1, so that all of it is seen and none of it is stretched. */
function reachOf(shot: Shot, canvasAspect: number): readonly [number, number] {
  const { width_px, height_px } = shot.lens;
  const aspect = shot.quarterTurns % 2 === 0 ? width_px / height_px : height_px / width_px;
  return aspect > canvasAspect ? [1, canvasAspect / aspect] : [aspect / canvasAspect, 1];
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
