/** What is shown where the square would be drawn in the wrong place: the way to it, and a plan. DOM only. */

import { element } from "./dom";
import { headingOf } from "./frames";
import type { SiteMap } from "./map";
import type { Overlay } from "./overlay";
import { wayTo, wayWords } from "./plan";
import type { FrameMessage } from "./wire";

/** Half the side of the plan about a visitor who is on the site, metres. */
const AROUND_M = 80;

export class Guide {
  /** Of the site, once it is known. */
  map: SiteMap | null = null;
  private readonly panel = element("wayfinder", HTMLElement);
  private readonly arrow = element("way", HTMLElement);
  private readonly words = element("way-words", HTMLElement);

  /** Show the way for this picture, or hide it where the square itself is drawn. */
  show({ pose, lens }: FrameMessage, { style, doubt }: Overlay): void {
    this.panel.hidden = style !== "guide" || pose === null || this.map === null;
    if (this.panel.hidden || pose === null || this.map === null) return;
    const heading_rad = pose.headingKnown ? headingOf(pose.T_site_cam) : null;
    const place = [pose.T_site_cam[3] ?? 0, pose.T_site_cam[7] ?? 0] as const;
    if (this.map.holds(place)) this.map.zoom(place, AROUND_M);
    this.map.show(place, heading_rad, Math.atan(lens.width_px / (2 * lens.fx_px)), doubt);
    const way = wayTo(place, heading_rad, this.map.middle);
    this.arrow.hidden = way.turn_rad === null;
    this.arrow.style.rotate = `${((way.turn_rad ?? 0) * 180) / Math.PI}deg`;
    this.words.textContent = wayWords(way);
  }
}
