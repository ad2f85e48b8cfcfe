/** One walker in the square: what its walk tells, drawn. */

import type { Group } from "three";
import type { Eye } from "../browse/eye";
import type { Session } from "../protocol";
import { length, minus, type Place } from "./between";
import { Figure } from "./figure";
import type { Shown } from "./poses";
import { Rest } from "./rest";
import { Ribbon } from "./ribbon";
import { Walk } from "./walk";

export class Guest {
  readonly walk: Walk;
  /** As in the last picture; null while nothing is known. */
  shown: Shown | null = null;
  private readonly rest = new Rest();
  private readonly figure: Figure;
  private readonly ribbon: Ribbon;

  /** `come` is called when a pose has come, `told` when there is something new to say. */
  constructor(session: Session, eyeHeight_m: number, place: Group, come: () => void, told: () => void) {
    this.figure = new Figure(eyeHeight_m);
    this.ribbon = new Ribbon(eyeHeight_m);
    place.add(this.figure.group, this.ribbon.line);
    this.walk = new Walk(session, {
      pose: (pose) => {
        if (pose.soughtJustBefore) this.ribbon.clear();
        this.ribbon.add(pose.p_site_body_m, pose.motionModel);
        come();
      },
      lens: (lens) => this.figure.showSight(lens),
      company: told,
    });
  }

  /** Whether the walker is seen to move. */
  get moves(): boolean {
    return this.shown !== null && this.rest.moves;
  }

  /** Return the walker as to be shown at `now_ms`; null while nothing is known. */
  at(now_ms: number): Shown | null {
    const shown = this.walk.poses.at(now_ms);
    return shown && { ...shown, ...placeOf(this.rest.at(shown, now_ms)) };
  }

  /**
   * Be where the walker is in the next picture, seen from `eye`, or out of their own eyes for null; return whether that is
   * another moment than in the last one.
   */
  turn(now_ms: number, eye: Eye | null): boolean {
    const before_ns = this.shown?.t_ns;
    this.shown = this.at(now_ms);
    const { shown } = this;
    if (shown) this.figure.show(shown, eye && length(minus(eye.place_site_m, shown.p_site_body_m)));
    return this.shown !== null && this.shown.t_ns !== before_ns;
  }

  close(): void {
    this.walk.close();
    this.figure.dispose();
    this.ribbon.dispose();
  }
}

function placeOf({ p_site_body_m, wxyz_site_body }: Place): Place {
  return { p_site_body_m, wxyz_site_body };
}
