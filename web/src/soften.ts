/**
 * How much of the model gives way beside what hides it: as wide as the pose is uncertain, from the hidden part outwards.
 *
 * What stands in front is in the drawing's depth, but not in its colours: there the drawing is empty and nearer than the sky.
 * That, small, is the first pass; the second looks about every pixel for the nearest such place in front of it. The hidden
 * part itself is never shown, however soft its edge.
 */

import {
  type DepthTexture,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  NoBlending,
  RedFormat,
  RGFormat,
  ShaderMaterial,
  type Texture,
  Vector2,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Quad } from "./quad";

/** One pixel here stands for this many of the drawing's, along each side. */
const COARSER = 4;
/** Wider than this share of the drawing nothing is softened: then the pose is no use at all. */
const WIDEST_SHARE = 0.06;
/** Narrower than this, in pixels of the drawing, an edge is sharp. */
const SHARP_PX = 1.5;
/** What hides is seldom nearer than this, metres: the widest edge is looked for in its breadth. */
const NEAREST_M = 4;

const VERTEX = /* glsl */ `
  varying vec2 vAt;
  void main() { vAt = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

/** Red: one over the distance, along the line of sight; green: whether it is of what hides. */
const FOUND = /* glsl */ `
  uniform sampler2D drawing; uniform sampler2D depth; uniform vec2 reach;
  varying vec2 vAt;
  void main() {
    float stored = texture2D(depth, vAt).r;
    float nearness = mix(1.0 / reach.x, 1.0 / reach.y, stored);
    float hides = stored < 1.0 && texture2D(drawing, vAt).a < 0.003 ? 1.0 : 0.0;
    gl_FragColor = vec4(nearness, hides, 0.0, 1.0);
  }`;

const SOFTENED = /* glsl */ `
  uniform sampler2D found; uniform vec2 texel; uniform float turn_px; uniform float place_px; uniform float widest_px;
  varying vec2 vAt;
  void main() {
    vec2 own = texture2D(found, vAt).rg;
    float given = own.g;
    for (int ring = 1; ring <= 3; ring++) {
      float away = widest_px * float(ring) / 3.0;
      for (int spoke = 0; spoke < 10; spoke++) {
        float angle = 0.6283185 * (float(spoke) + 0.5 * float(ring));
        vec2 there = texture2D(found, vAt + away * texel * vec2(cos(angle), sin(angle))).rg;
        float width = min(length(vec2(turn_px, place_px * there.r)), widest_px);
        if (there.g > 0.5 && there.r > own.r) given = max(given, 1.0 - max(away - widest_px / 3.0, 0.0) / width);
      }
    }
    gl_FragColor = vec4(given, 0.0, 0.0, 1.0);
  }`;

/** How far off a pose may be: what softens. */
export interface Doubted {
  /** Across the ground, metres, 1 sigma. */
  readonly place_m: number;
  /** Heading, radians, 1 sigma. */
  readonly heading_rad: number;
}

export class SoftEdges {
  private readonly found = small(RGFormat, NearestFilter);
  private readonly softened = small(RedFormat, LinearFilter);
  private readonly quad = new Quad();
  private readonly finding = pass(FOUND, { drawing: null, depth: null, reach: new Vector2() });
  private readonly softening = pass(SOFTENED, {
    found: null,
    texel: new Vector2(),
    turn_px: 0,
    place_px: 0,
    widest_px: 0,
  });

  /** How much gives way, 0 to 1, over the drawing. */
  get texture(): Texture {
    return this.softened.texture;
  }

  /**
   * Work it out for a drawing; false where every edge is sharp.
   *
   * `focal_px` in the drawing's pixels; `reach` are its near and far plane, metres.
   */
  take(
    renderer: WebGLRenderer,
    drawing: WebGLRenderTarget,
    depth: DepthTexture,
    focal_px: number,
    doubt: Doubted,
    reach: readonly [number, number],
  ): boolean {
    const turn_px = focal_px * doubt.heading_rad;
    const place_px = focal_px * doubt.place_m;
    const widest_px = Math.min(Math.hypot(turn_px, place_px / NEAREST_M), WIDEST_SHARE * drawing.width);
    if (!(Math.hypot(turn_px, place_px / (10 * NEAREST_M)) > SHARP_PX)) return false;
    const size = [drawing.width, drawing.height].map((side) => Math.max(1, Math.round(side / COARSER)));
    const [width = 1, height = 1] = size;
    for (const target of [this.found, this.softened])
      if (target.width !== width || target.height !== height) target.setSize(width, height);
    set(this.finding, { drawing: drawing.texture, depth, reach: new Vector2(...reach) });
    this.render(renderer, this.finding, this.found);
    const texel = new Vector2(1 / drawing.width, 1 / drawing.height);
    set(this.softening, { found: this.found.texture, texel, turn_px, place_px, widest_px });
    this.render(renderer, this.softening, this.softened);
    return true;
  }

  private render(renderer: WebGLRenderer, material: ShaderMaterial, target: WebGLRenderTarget): void {
    this.quad.material = material;
    renderer.setRenderTarget(target);
    this.quad.draw(renderer);
  }
}

function small(format: typeof RGFormat | typeof RedFormat, filter: typeof NearestFilter | typeof LinearFilter) {
  return new WebGLRenderTarget(1, 1, {
    type: HalfFloatType,
    format,
    minFilter: filter,
    magFilter: filter,
    depthBuffer: false,
  });
}

function pass(fragmentShader: string, uniforms: Readonly<Record<string, unknown>>): ShaderMaterial {
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader,
    uniforms: {},
    blending: NoBlending,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
  });
  set(material, uniforms);
  return material;
}

function set(material: ShaderMaterial, values: Readonly<Record<string, unknown>>): void {
  for (const [name, value] of Object.entries(values)) {
    const uniform = material.uniforms[name];
    if (uniform) uniform.value = value;
    else material.uniforms[name] = { value };
  }
}
