/**
 * Pictures out of JPEGs: as the planes that they are made of where the browser hands these out, else as a bitmap.
 *
 * A bitmap is every pixel's colour, which takes a processor several times as long as the planes do; who draws planes works
 * the colours out on the way (`film.ts`).
 */

import { arePlanes, type Planes, planesIn, roomFor } from "./planes";

/** A picture to be shown; to be closed when it no longer is. */
export interface Picture {
  readonly pixels: ImageBitmap | Planes;
  close(): void;
}

/** Where there were no planes, bitmaps are made of as many pictures before planes are asked for again. */
const BITMAPS_MEANWHILE = 50;

export class Decoder {
  /** Of how many pictures no planes are asked for; a page without TLS has no `ImageDecoder`. */
  private bitmaps = "ImageDecoder" in globalThis ? 0 : Number.POSITIVE_INFINITY;
  /** What closed pictures have left, for the next ones. */
  private readonly rooms: Uint8Array<ArrayBuffer>[] = [];

  /** Decode a JPEG; rejects where it is broken. */
  async decode(jpeg: Uint8Array<ArrayBuffer>): Promise<Picture> {
    // what is wrong with it, if it is not the browser that has no planes, is found by the bitmap
    const planar = this.bitmaps > 0 ? null : await this.planar(jpeg).catch(() => null);
    if (planar) return planar;
    const blob = new Blob([jpeg], { type: "image/jpeg" });
    const pixels = await createImageBitmap(blob, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
    this.bitmaps = this.bitmaps > 0 ? this.bitmaps - 1 : BITMAPS_MEANWHILE;
    return { pixels, close: () => pixels.close() };
  }

  /** Return a picture as planes; null where it is none, or not to be shown as they are. */
  private async planar(jpeg: Uint8Array<ArrayBuffer>): Promise<Picture | null> {
    const decoder = new ImageDecoder({ data: jpeg, type: "image/jpeg", colorSpaceConversion: "none" });
    try {
      const { image } = await decoder.decode();
      try {
        if (!arePlanes(image) || image.format === null) return null;
        const { format, codedWidth, codedHeight } = image;
        const room = this.room(roomFor(format, codedWidth, codedHeight));
        await image.copyTo(room);
        const pixels = planesIn(room, format, codedWidth, codedHeight);
        return { pixels, close: () => this.rooms.push(room) };
      } finally {
        image.close();
      }
    } finally {
      decoder.close();
    }
  }

  private room(bytes: number): Uint8Array<ArrayBuffer> {
    const room = this.rooms.pop();
    return room?.length === bytes ? room : new Uint8Array(bytes);
  }
}
