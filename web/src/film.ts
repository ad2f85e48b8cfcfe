/** A picture on the graphics card, for a shader that asks for what is `seen` at a place of it. three.js only. */

import { DataTexture, LinearFilter, NoColorSpace, RedFormat, RGFormat, Texture, Vector2 } from "three";
import type { Picture } from "./decoding";

/**
 * Needs `PLANAR` to be defined where the picture is planes.
 *
 * The filter between the samples of chroma is libjpeg's ("fancy upsampling"), so that colours come out as a bitmap's do, within 1 of 255.
 */
export const SEEN = /* glsl */ `
  #ifdef PLANAR
    uniform sampler2D luma; uniform sampler2D chroma; uniform vec2 within;
    vec3 seen(vec2 at) {
      vec2 c = texture2D(chroma, at * within).rg - 0.50196078;
      vec3 colour = vec3(1.402 * c.g, -0.344136 * c.r - 0.714136 * c.g, 1.772 * c.r);
      return clamp(texture2D(luma, at).r + colour, 0.0, 1.0);
    }
  #else
    uniform sampler2D bitmap;
    vec3 seen(vec2 at) { return texture2D(bitmap, at).rgb; }
  #endif`;

export class Film {
  private readonly bitmap = prepared(new Texture());
  private readonly luma = prepared(new DataTexture(null, 1, 1, RedFormat));
  private readonly chroma = prepared(new DataTexture(null, 1, 1, RGFormat));
  /** How much of chroma the picture covers: all of it where its size is even. */
  private readonly within = new Vector2(1, 1);
  private picture: Picture | null = null;

  /** For the material whose shader has `SEEN`. */
  get uniforms(): Readonly<Record<string, { value: unknown }>> {
    return {
      bitmap: { value: this.bitmap },
      luma: { value: this.luma },
      chroma: { value: this.chroma },
      within: { value: this.within },
    };
  }

  /** Whether the picture is planes. */
  get isPlanar(): boolean {
    return this.picture !== null && "luma" in this.picture.pixels;
  }

  /** Show this picture from now on. */
  show(picture: Picture): void {
    if (this.picture === picture) return;
    this.picture = picture;
    const { pixels } = picture;
    if ("luma" in pixels) {
      const { luma, chroma, coarser } = pixels;
      fill(this.luma, { width: luma.width, height: luma.height, data: luma.bytes });
      fill(this.chroma, { width: chroma.width, height: chroma.height, data: chroma.bytes });
      this.within.set(luma.width / (coarser[0] * chroma.width), luma.height / (coarser[1] * chroma.height));
    } else fill(this.bitmap, pixels);
  }

  /** Send the picture anew, after the browser has taken the graphics away. */
  resend(): void {
    if (this.picture === null) return;
    for (const texture of this.isPlanar ? [this.luma, this.chroma] : [this.bitmap]) texture.needsUpdate = true;
  }
}

/** What a texture is made of: a bitmap, or bytes. */
interface Content {
  readonly width: number;
  readonly height: number;
  readonly data?: Uint8Array;
}

function fill(texture: Texture, image: Content): void {
  const before = texture.image as Content | null;
  // a texture of another size cannot take the new picture in place
  if (before?.width !== image.width || before.height !== image.height) texture.dispose();
  texture.image = image;
  texture.needsUpdate = true;
}

function prepared(texture: Texture): Texture {
  texture.colorSpace = NoColorSpace;
  texture.flipY = false;
  texture.generateMipmaps = false;
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  return texture;
}
