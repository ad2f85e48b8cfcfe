/** What tests and support see of a page that shows a walk's pictures: read-only but for `setPast`, and what a page adds. */

import type { Vector3 } from "./frames";
import type { Session } from "./protocol";
import type { Viewer } from "./viewer";

/** A page as it is published. */
export interface Published {
  readonly viewer: Viewer;
  readonly ready: Promise<void>;
  readonly session: Session | null;
}

/** Put `globalThis.agora` in place. */
export function publishViewer(page: Published, more: Readonly<Record<string, unknown>> = {}): void {
  const { viewer } = page;
  const api = {
    ready: page.ready,
    stats: () => ({
      framesDrawn: viewer.framesDrawn,
      posesDrawn: viewer.posesDrawn,
      mismatchedFrames: viewer.mismatched,
      lastFrameId: viewer.frame?.frameId ?? null,
      lastPoseFrameId: viewer.pose?.frameId ?? null,
      position_s: viewer.frame?.position_s ?? null,
      poseAgeMs: viewer.age.at(performance.now()),
      motionModel: viewer.pose?.motionModel ?? null,
      estimator: viewer.pose?.estimator ?? null,
      overlay: viewer.overlay.style,
      drawCalls: viewer.composite.cost.calls,
      triangles: viewer.composite.cost.triangles,
      occluders: viewer.square?.hasOccluders ?? false,
      effort: viewer.look.effort.name,
      drawMs: viewer.look.usual_ms,
      sun: viewer.look.sun,
      gain: viewer.composite.gain,
    }),
    project: (point: Vector3) => viewer.project(point),
    pose: () => {
      const { pose } = viewer;
      return pose && { t_ns: pose.t_ns, frameId: pose.frameId, T_site_cam: pose.T_site_cam, cov: pose.covariance };
    },
    session: () => page.session,
    setPast: (share: number) => viewer.setPast(share),
    readPixels: (x: number, y: number, width: number, height: number) => viewer.composite.read(x, y, width, height),
    ...more,
  };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}
