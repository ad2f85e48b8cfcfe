/** Where a replay's page has its walk from: a server that plays it, or the page itself. */

import type { Request } from "../playback";
import type { Session } from "../protocol";
import type { Site } from "../site";
import type { Connection } from "../words";
import type { Course, Timeline } from "./review";

export interface Source {
  /** Of the walk. */
  readonly name: string;
  /** Whether a server plays it: then there are other estimators, the walk can be taken away, and another one be brought. */
  readonly isServed: boolean;
  /** Begin to tell. */
  start(listener: Listener): void;
  /** Ask for another place, speed or estimator; what became of it is told to the listener. */
  ask(request: Request): void;
  /** A picture was drawn, or left out. */
  done(frameId: number): void;
  site(): Promise<Site>;
  timeline(): Promise<Timeline>;
  /** The strip of small pictures; null where the walk has none, or they may not be seen. */
  thumbnails(): Promise<ImageBitmap | null>;
  /** What an estimator makes of the walk; fails with a sentence where it cannot. */
  course(estimator: string): Promise<Course>;
}

export interface Listener {
  session(session: Session): void;
  picture(bytes: ArrayBuffer): void;
  /** What arrived cannot be read. */
  garbled(bytes: ArrayBuffer | null): void;
  /** Something that was asked for was refused, with the rig's reason if it gives one. */
  refused(reason: string | null): void;
  connection(state: Connection): void;
}
