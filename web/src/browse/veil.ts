/** What was drawn last, kept and drawn over what is drawn next, to fade from one to the other. three.js only. */

import { FramebufferTexture, ShaderMaterial, Vector2, type WebGLRenderer } from "three";
import { Quad } from "../quad";

const VERTEX = /* glsl */ `
  varying vec2 vAt;
  void main() { vAt = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }`;

/** The colours are the screen's own: they are neither mapped nor converted. */
const FRAGMENT = /* glsl */ `
  uniform sampler2D picture; uniform float share; uniform float part;
  varying vec2 vAt;
  void main() { gl_FragColor = vec4(texture2D(picture, vAt * part).rgb, share); }`;

export class Veil {
  private picture: FramebufferTexture | null = null;
  private readonly material = new ShaderMaterial({
    uniforms: { picture: { value: null }, share: { value: 1 }, part: { value: 1 } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    transparent: true,
    depthTest: false,
    depthWrite: false,
    toneMapped: false,
  });

  readonly quad = new Quad(this.material);

  /** Keep what is drawn now. */
  take(renderer: WebGLRenderer): void {
    const { x, y } = renderer.getDrawingBufferSize(new Vector2());
    if (this.picture?.image.width !== x || this.picture.image.height !== y) {
      this.picture?.dispose();
      this.picture = new FramebufferTexture(x, y);
    }
    renderer.copyFramebufferToTexture(this.picture);
  }

  /** Draw what was kept, by that share; `part` is how much of each side of the canvas was drawn to. */
  draw(renderer: WebGLRenderer, share: number, part: number): void {
    const uniforms = this.material.uniforms as Record<"picture" | "share" | "part", { value: unknown }>;
    [uniforms.picture.value, uniforms.share.value, uniforms.part.value] = [this.picture, share, part];
    this.quad.draw(renderer);
  }
}
