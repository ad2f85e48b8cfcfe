/**
 * A picture as JPEGs hold it: brightness of each pixel, and colour that may be coarser. Pure.
 *
 * JPEGs are of full range by ITU-R BT.601, each sample of the coarser planes amidst the pixels that it is for (JFIF 1.02).
 */

/** Bytes row by row, the top one first. */
export interface Plane {
  readonly width: number;
  readonly height: number;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

export interface Planes {
  readonly luma: Plane;
  /** Two bytes a sample: blue less luma, red less luma, both from 128. */
  readonly chroma: Plane;
  /** How many pixels, across and down, a sample of chroma is for. */
  readonly coarser: readonly [number, number];
}

/** What is to be known of a decoded picture; a `VideoFrame` tells it. */
export interface Described {
  readonly format: string | null;
  readonly codedWidth: number;
  readonly codedHeight: number;
  readonly displayWidth: number;
  readonly displayHeight: number;
  readonly colorSpace: { readonly fullRange: boolean | null; readonly matrix: string | null };
  /** Where the browser tells it: clockwise degrees to turn it by, and whether to mirror it. */
  readonly rotation?: number;
  readonly flip?: boolean;
}

const COARSER: Readonly<Record<string, readonly [number, number]>> = { I420: [2, 2], I422: [2, 1], I444: [1, 1] };

/** Whether a picture is three planes, upright and of a JPEG's colours. */
export function arePlanes(picture: Described): boolean {
  const { format, colorSpace } = picture;
  return (
    format !== null &&
    format in COARSER &&
    picture.displayWidth === picture.codedWidth &&
    picture.displayHeight === picture.codedHeight &&
    colorSpace.fullRange === true &&
    colorSpace.matrix === "smpte170m" &&
    picture.rotation === 0 &&
    picture.flip === false
  );
}

/** Return how many bytes `planesIn` needs for a picture. */
export function roomFor(format: string, width: number, height: number): number {
  const [w, h] = chromaSize(format, width, height);
  return width * height + 4 * w * h;
}

/**
 * Return the planes that lie one behind the other, without gaps, at the beginning of a room.
 *
 * The two of colour are put together, as graphics cards read them, behind the three: the room has space for that.
 */
export function planesIn(room: Uint8Array<ArrayBuffer>, format: string, width: number, height: number): Planes {
  const [w, h] = chromaSize(format, width, height);
  const [blue, red, both] = [width * height, width * height + w * h, width * height + 2 * w * h];
  for (let i = 0, to = both; i < w * h; i++, to += 2) {
    room[to] = room[blue + i] as number;
    room[to + 1] = room[red + i] as number;
  }
  return {
    luma: { width, height, bytes: room.subarray(0, blue) },
    chroma: { width: w, height: h, bytes: room.subarray(both, both + 2 * w * h) },
    coarser: COARSER[format] ?? [1, 1],
  };
}

/** Return RGBA bytes of so many pixels, spread evenly. */
export function spread({ luma, chroma, coarser }: Planes, columns: number, rows: number): Uint8ClampedArray {
  const rgba = new Uint8ClampedArray(4 * columns * rows);
  for (let row = 0, i = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++, i += 4) {
      const x = Math.floor(((column + 0.5) / columns) * luma.width);
      const y = Math.floor(((row + 0.5) / rows) * luma.height);
      const at = 2 * (Math.floor(y / coarser[1]) * chroma.width + Math.floor(x / coarser[0]));
      const bright = luma.bytes[y * luma.width + x] ?? 0;
      const [blue, red] = [(chroma.bytes[at] ?? 128) - 128, (chroma.bytes[at + 1] ?? 128) - 128];
      rgba.set([bright + 1.402 * red, bright - 0.344136 * blue - 0.714136 * red, bright + 1.772 * blue, 255], i);
    }
  }
  return rgba;
}

function chromaSize(format: string, width: number, height: number): readonly [number, number] {
  const [across, down] = COARSER[format] ?? [1, 1];
  return [Math.ceil(width / across), Math.ceil(height / down)];
}
