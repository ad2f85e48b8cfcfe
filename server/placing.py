"""Where a walk is put: the site's frame, the ground under the eyes, or the place where the walk itself began."""

from dataclasses import dataclass
from typing import Literal

from tracker.estimator import Origin, Pose
from tracker.estimators import PRECISE
from tracker.grounding import GroundHeight, on_ground
from tracker.levelled import Levelled
from tracker.measurements import GpsFix
from tracker.pipeline import Pipeline
from tracker.precise.ground import EyeHeight

Anchor = Literal["site", "here"]
Height = Literal["ground", "gps"]


@dataclass(frozen=True)
class Placing:
    """A site for the tracker's purposes, and how walks are put there."""

    site_origin: Origin
    ground_z_m: GroundHeight
    """The ground's height everywhere about it, onto which poses are put."""
    eyes_z_m: EyeHeight
    """Height of the eyes where one can stand, for estimators that measure by it."""
    eye_height_m: float
    """Of the eyes above the ground."""
    anchor: Anchor = "site"
    height: Height = "ground"

    def origin(self, first_fix: GpsFix | None) -> Origin:
        """Return where the site frame is laid: where it is, or with its origin under the walk's first fix."""
        if self.anchor == "site" or first_fix is None:
            return self.site_origin
        return Origin(first_fix.lat_deg, first_fix.lon_deg, first_fix.h_ellipsoid_m - self.eye_height_m)

    def measures_ground(self, estimator: str) -> bool:
        """Whether the estimator itself asks for the ground. Where the walk was elsewhere, the site's is not what was walked on."""
        return estimator.endswith(f"/{PRECISE}") and self.anchor == "site" and self.height == "ground"

    def eyes_for(self, estimator: str) -> EyeHeight | None:
        """Return what an estimator is told of the ground."""
        return self.eyes_z_m if self.measures_ground(estimator) else None

    def levelled(self, pipeline: Pipeline) -> Pipeline:
        """Return a pipeline whose first pose stands on the ground, where the site is laid at the walk's beginning."""
        if self.anchor == "here":
            pipeline.estimator = Levelled(pipeline.estimator, self.eye_height_m)
        return pipeline

    def placed(self, pose: Pose | None, estimator: str) -> Pose | None:
        """Return a pose as it is shown."""
        if pose is None or estimator == "truth" or self.height == "gps" or self.measures_ground(estimator):
            return pose
        return on_ground(pose, self.ground_z_m, self.eye_height_m)
