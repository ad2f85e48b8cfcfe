/** Whether others see the camera's picture: the walker's switch, and a mark for everybody while it is on. */

import { element } from "./dom";
import { say } from "./language/speech";
import type { Hello, Session } from "./messages.gen";

export interface ShareRequest {
  readonly action: "share";
  readonly value: boolean;
}

export class Sharing {
  private readonly mark = element("sharing", HTMLElement);
  private readonly button = element("share", HTMLButtonElement);
  private role: Hello["role"] = "viewer";
  private shared = false;

  constructor(ask: (request: ShareRequest) => void) {
    this.button.onclick = () => ask({ action: "share", value: !this.shared });
  }

  /** Show a session's state; `role` is null where the message does not say it again. */
  show(session: Session, role: Hello["role"] | null): void {
    this.role = role ?? this.role;
    this.shared = session.sharing;
    this.button.hidden = this.role !== "rig";
    this.button.setAttribute("aria-pressed", String(this.shared));
    this.button.textContent = say(this.shared ? "share.stop" : "share.start");
    this.mark.textContent = markOf(session.sharing, this.role);
    this.mark.hidden = this.mark.textContent === "";
  }
}

/** Return what is said beside the walk's name; nothing on a rig's own machine, where nobody else can watch. */
export function markOf(sharing: boolean, role: Hello["role"]): string {
  if (role === "local") return "";
  if (sharing) return say("share.on");
  return role === "rig" ? "" : say("share.off");
}
