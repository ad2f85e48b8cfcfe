/**
 * The sheet on which picture and model become one image: it keeps the picture's own pixels, and bends the model onto them.
 *
 * A program does no more than it must, for there a card may be missing and every pixel costs: what is not drawn, like outlines
 * or softened edges, is left out of it. three.js only.
 */

import {
  BufferAttribute,
  BufferGeometry,
  Mesh,
  NoBlending,
  OrthographicCamera,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
  Vector4,
  type WebGLRenderer,
} from "three";
import type { Picture } from "./decoding";
import type { Drawing } from "./drawing";
import { Film, SEEN } from "./film";
import type { Matrix4 } from "./frames";
import type { Pair } from "./lens";
import type { Lookup } from "./lookup";
import type { Laying } from "./overlay";

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
  ${SEEN}
  uniform sampler2D drawing; uniform sampler2D edges;
  uniform float past; uniform float share; uniform vec3 gain; uniform float outline; uniform vec2 texel;
  uniform vec4 window; uniform vec3 upCam; uniform float eyeHeight; uniform float clearTo;
  varying vec2 vPlace; varying vec2 vDrawn; varying float vKnown;
  vec3 lit(vec3 c) {
    c *= gain;
    return clamp(c / (1.0 + 0.12 * c), 0.0, 1.0);
  }
  // sRGB by roots alone, within half a step of 255: a power costs several times as much
  vec3 toSrgb(vec3 c) {
    c = lit(c);
    vec3 a = sqrt(c), b = sqrt(a);
    vec3 bright = 0.585122381 * a + 0.783140355 * b - 0.368262736 * sqrt(b);
    return mix(bright, 12.92 * c, vec3(lessThan(c, vec3(0.0031308))));
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
  #ifdef OUTLINED
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
  #endif
  void main() {
    vec3 colour = seen(vPlace);
    #ifdef MODELLED
      if (vKnown > 0.999) {
        float left = past * kept();
        #ifdef SOFT
          left *= 1.0 - texture2D(edges, vDrawn).r;
        #endif
        vec4 model = texture2D(drawing, vDrawn);
        if (model.a > 0.003) colour = mix(colour, toSrgb(model.rgb / model.a), clamp(model.a, 0.0, 1.0) * share * left);
        #ifdef OUTLINED
          colour = mix(colour, vec3(0.98, 0.9, 0.72), outline * edge() * left);
        #endif
      }
    #endif
    gl_FragColor = vec4(colour, 1.0);
  }`;

/** What is laid over the picture. */
export interface Cover {
  /** Whether the edges of what hides the model are softened. */
  readonly isSoft: boolean;
  /** How much of the past is shown, 0 to 1. */
  readonly past: number;
  /** What the model's linear colours are multiplied by. */
  readonly gain: readonly [number, number, number];
  readonly laying: Laying;
  readonly T_site_cam: Matrix4;
}

export class Sheet {
  private readonly film = new Film();
  private readonly flat = new OrthographicCamera();
  private readonly scene = new Scene();
  private readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private window = new Vector4();

  constructor(private readonly drawing: Drawing) {
    const material = new ShaderMaterial({
      uniforms: {
        ...this.film.uniforms,
        drawing: { value: drawing.target.texture },
        edges: { value: drawing.soft.texture },
        gain: { value: new Vector3(1, 1, 1) },
        pictureSize: { value: new Vector2(1, 1) },
        reach: { value: new Vector2(1, 1) },
        quarterTurns: { value: 0 },
        past: { value: 1 },
        share: { value: 1 },
        outline: { value: 0 },
        texel: { value: new Vector2(1, 1) },
        window: { value: this.window },
        upCam: { value: new Vector3() },
        eyeHeight: { value: 1 },
        clearTo: { value: 0 },
      },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      blending: NoBlending,
      depthTest: false,
      depthWrite: false,
      toneMapped: false,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  /** Show this picture from now on. */
  show(picture: Picture): void {
    this.film.show(picture);
  }

  /** Send the picture anew, after the browser has taken the graphics away. */
  resend(): void {
    this.film.resend();
  }

  /** Bend the model by this lookup from now on. */
  bend(lookup: Lookup, pictureSize_px: Pair): void {
    const { left, right, top, bottom } = lookup.window;
    this.window.set(left, right, top, bottom);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometryOf(lookup);
    this.value("pictureSize", new Vector2(...pictureSize_px));
  }

  /** Lay the model over the picture in this way; null: the picture alone. */
  cover(cover: Cover | null): void {
    this.compile({
      PLANAR: this.film.isPlanar,
      MODELLED: cover !== null,
      SOFT: cover?.isSoft ?? false,
      OUTLINED: (cover?.laying.outline ?? 0) > 0,
    });
    if (cover === null) return;
    const { laying, T_site_cam } = cover;
    const { width, height } = this.drawing.target;
    const [x = 0, y = 0, z = 0] = T_site_cam.slice(8, 11);
    this.value("past", cover.past);
    this.value("gain", new Vector3(...cover.gain));
    this.value("share", laying.share);
    this.value("outline", laying.outline);
    this.value("texel", new Vector2(1.2 / width, 1.2 / height));
    this.value("upCam", new Vector3(x, y, z));
    this.value("eyeHeight", laying.eye_m);
    this.value("clearTo", laying.clear_m);
  }

  /** Draw it: as far as it reaches in the viewport, and turned. */
  render(renderer: WebGLRenderer, reach: Pair, quarterTurns: number): void {
    this.value("reach", new Vector2(...reach));
    this.value("quarterTurns", quarterTurns);
    renderer.render(this.scene, this.flat);
  }

  private value(name: string, value: unknown): void {
    const uniform = this.mesh.material.uniforms[name];
    if (uniform) uniform.value = value;
  }

  /** Draw by the program of these parts; one that has been in use is kept. */
  private compile(parts: Readonly<Record<string, boolean>>): void {
    const { material } = this.mesh;
    const wanted = Object.keys(parts).filter((part) => parts[part]);
    const now = Object.keys(material.defines);
    if (wanted.length === now.length && wanted.every((part) => part in material.defines)) return;
    material.defines = Object.fromEntries(wanted.map((part) => [part, ""]));
    material.needsUpdate = true;
  }
}

function geometryOf({ columns, rows, places_px, uv, known }: Lookup): BufferGeometry {
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
