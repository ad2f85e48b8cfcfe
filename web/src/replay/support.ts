/** What tests and support see of a replay's page, as of the AR page: read-only but for `setPast`. */

import type { Vector3 } from "../frames";
import type { ReplayPage } from "./page";

/** Put `globalThis.agora` in place. */
export function publish(page: ReplayPage): void {
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
      motionModel: viewer.pose?.motionModel ?? null,
      estimator: viewer.pose?.estimator ?? null,
      overlay: viewer.overlay.style,
      drawCalls: viewer.composite.cost.calls,
      triangles: viewer.composite.cost.triangles,
      effort: viewer.look.effort.name,
    }),
    project: (point: Vector3) => viewer.project(point),
    pose: () => {
      const { pose } = viewer;
      return pose && { t_ns: pose.t_ns, frameId: pose.frameId, T_site_cam: pose.T_site_cam, cov: pose.covariance };
    },
    session: () => page.session,
    setPast: (share: number) => viewer.setPast(share),
    readPixels: (x: number, y: number, width: number, height: number) => viewer.composite.read(x, y, width, height),
  };
  Object.defineProperty(globalThis, "agora", { value: Object.freeze(api) });
}
