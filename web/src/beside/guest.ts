/** One walker in the square: what its walk tells, drawn. */

import type { Group } from "three";
import type { Session } from "../protocol";
import { Figure } from "./figure";
import type { Shown } from "./poses";
import { Ribbon } from "./ribbon";
import { Walk } from "./walk";

export class Guest {
  readonly walk: Walk;
  /** As in the last picture; null while nothing is known. */
  shown: Shown | null = null;
  private readonly figure: Figure;
  private readonly ribbon: Ribbon;

  /** `changed` is called when a picture is wanted, `told` when there is something new to say. */
  constructor(session: Session, eyeHeight_m: number, place: Group, changed: () => void, told: () => void) {
    this.figure = new Figure(eyeHeight_m);
    this.ribbon = new Ribbon(eyeHeight_m);
    place.add(this.figure.group, this.ribbon.line);
    this.walk = new Walk(session, {
      pose: (pose) => {
        if (pose.soughtJustBefore) this.ribbon.clear();
        this.ribbon.add(pose.p_site_body_m, pose.motionModel);
        changed();
      },
      lens: (lens) => this.figure.showSight(lens),
      company: () => {
        changed();
        told();
      },
    });
  }

  /** Be where the walker is in the next picture; return whether that is another place or time than in the last one. */
  turn(now_ms: number, isSelf: boolean): boolean {
    const before_ns = this.shown?.t_ns;
    this.shown = this.walk.poses.at(now_ms);
    if (this.shown) this.figure.show(this.shown, isSelf);
    return this.shown !== null && this.shown.t_ns !== before_ns;
  }

  close(): void {
    this.walk.close();
    this.figure.dispose();
    this.ribbon.dispose();
  }
}
