/** How bright a picture is. */

import type { Picture } from "./decoding";
import { meanLight } from "./exposure";
import type { Vector3 } from "./frames";
import { spread } from "./planes";

/** Of so many of its pixels. */
const METERED_PX = [32, 24] as const;

export class Meter {
  private readonly drawing = new OffscreenCanvas(...METERED_PX).getContext("2d", { willReadFrequently: true });

  /** Return the mean light of a picture, linear; null where the browser cannot tell. */
  lightOf({ pixels }: Picture): Vector3 | null {
    if ("luma" in pixels) return meanLight(spread(pixels, ...METERED_PX));
    if (!this.drawing) return null;
    this.drawing.drawImage(pixels, 0, 0, ...METERED_PX);
    return meanLight(this.drawing.getImageData(0, 0, ...METERED_PX).data);
  }
}
