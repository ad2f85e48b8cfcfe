/**
 * What stands still, drawn once and kept with its depth: who moves before it, or behind it, costs little more than themselves.
 * three.js only.
 */

import {
  AlwaysDepth,
  DepthTexture,
  ShaderMaterial,
  SRGBColorSpace,
  UnsignedIntType,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import { Quad } from "../quad";

/** As many as browsers take for a canvas with smooth edges. */
const SAMPLES = 4;

const VERTEX = /* glsl */ `
  void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;

/** The colours are the screen's own: they are neither mapped nor converted. */
const FRAGMENT = /* glsl */ `
  uniform sampler2D picture; uniform highp sampler2D depth;
  void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    gl_FragColor = vec4(texelFetch(picture, at, 0).rgb, 1.0);
    gl_FragDepth = texelFetch(depth, at, 0).r;
  }`;

export class Still {
  private target: WebGLRenderTarget | null = null;
  private kept = false;
  private readonly material = new ShaderMaterial({
    uniforms: { picture: { value: null }, depth: { value: null } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    depthFunc: AlwaysDepth,
    toneMapped: false,
  });

  readonly quad = new Quad(this.material);

  get isKept(): boolean {
    return this.kept;
  }

  /** Keep what `paint` draws, so many pixels wide and high; it may say that this is not to be used again. */
  take(renderer: WebGLRenderer, width: number, height: number, paint: () => void): void {
    this.kept = true;
    renderer.setRenderTarget(this.targetOf(width, height));
    paint();
    renderer.setRenderTarget(null);
  }

  /** Draw what was kept, its depth too. */
  draw(renderer: WebGLRenderer): void {
    this.quad.draw(renderer);
  }

  /** What was kept is so no longer. */
  forget(): void {
    this.kept = false;
  }

  private targetOf(width: number, height: number): WebGLRenderTarget {
    if (this.target?.width === width && this.target.height === height) return this.target;
    this.target?.depthTexture?.dispose();
    this.target?.dispose();
    const target = new WebGLRenderTarget(width, height, {
      samples: SAMPLES,
      colorSpace: SRGBColorSpace,
      internalFormat: "RGBA8", // its shaders give the screen's colours already
      generateMipmaps: false,
      depthTexture: new DepthTexture(width, height, UnsignedIntType),
    });
    // three.js draws into such a target as onto the screen: by the same programs, mapped and converted alike
    Object.assign(target, { isXRRenderTarget: true });
    const { picture, depth } = this.material.uniforms as Record<"picture" | "depth", { value: unknown }>;
    [picture.value, depth.value] = [target.texture, target.depthTexture];
    this.target = target;
    return target;
  }
}
