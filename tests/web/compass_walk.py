"""A walk whose compass is 15 degrees off: the visitor stands, looks at three landmarks, and walks on. Nobody draws its pictures."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from heapq import merge
from math import cos, radians, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assets.site import load_site
from server.motions import Unseen, poses_of
from server.replay import ReplaySettings
from server.showing import Showing
from tests.web.walk import ROOT, WEB, make_site
from tracker import lens
from tracker.blank import blank_picture
from tracker.feature_camera import FeatureCamera
from tracker.itinerary import Itinerary, Leg, Look, planned_s
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, MagSample, Matrix, Measurement, Vector3, VisualMotion
from tracker.rig import CameraModel
from tracker.simulate import START_NS, Walk, WalkSettings, default_rig, simulate
from tracker.vision import VisionFrontEnd, VisionSettings

NAME = "compass-walk"
COMPASS_OFF_RAD = radians(15.0)
STILL_S = 10.0
LANDMARKS = ("temple_corner_ne", "basilica_column_west", "east_stoa_north")
TAPS_S = (12.5, 30.0, 36.0)
"""When each of them is looked at, and the head is still."""
TURNING_S = (14.5, 26.0)
"""Between the first tap and the second: the head turns about, and the first landmark stays in sight."""
REST_S = (38.0, 98.0)
"""The minute after."""
_PER_S = 10.0


def point_of(landmark: str) -> Vector3:
    """Return a landmark's point."""
    (found,) = (one for one in load_site(ROOT / "assets" / "state_agora").landmarks if one.id == landmark)
    return found.point_m


def _plan() -> Itinerary:
    first, second, third = (point_of(landmark) for landmark in LANDMARKS)

    def beside(e_m: float) -> Vector3:
        return (first[0], first[1] + e_m, 1.0)

    about = tuple(Look(beside(side_m), 2.5) for side_m in (7.0, -7.0, 6.0, -6.0, 0.0))
    return Itinerary(
        (-30.0, -8.0),
        first,
        (
            Leg((-29.9, -8.0), 0.5, (), (Look(first, 3.6), *about, Look(second, 6.0), Look(third, 6.0))),
            Leg((-28.0, -8.3), 0.8, (Look(third, 3.0),), (Look(second, 6.0), Look(first, 7.0), Look(second, 5.0))),
            Leg((-6.0, -12.0), 1.2, (Look(None, 6.0), Look(second, 7.0)), (Look(third, 7.0), Look(first, 8.0))),
            Leg((-12.0, -10.0), 1.0, (Look(None, 3.0),), (Look(second, 9.0),)),
        ),
    )


@dataclass(frozen=True)
class _Points:
    """Corners on the ground and on what stands about."""

    p_site_m: Matrix
    strength: Matrix
    on_rim: NDArray[np.bool_]

    def corners(self, p_site_m: Matrix) -> "_Points":
        """Return all of them."""
        return self


def _points() -> _Points:
    rng, count = np.random.default_rng(5), 3000
    angle, away_m = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(12.0, 60.0, count)
    places = np.column_stack(
        [-22.0 + away_m * np.cos(angle), -8.0 + away_m * np.sin(angle), rng.uniform(0.0, 7.0, count)]
    )
    return _Points(places, np.sort(rng.uniform(0.1, 1.0, count))[::-1], rng.random(count) < 0.3)


class CompassWalk:
    """The truth of it."""

    @cached_property
    def walk(self) -> Walk:
        """As it was walked."""
        plan = _plan()
        seconds = max(planned_s(plan, STILL_S), REST_S[1]) + 2.0
        settings = WalkSettings(
            seed=3, duration_s=seconds, still_s=STILL_S, imu_hz=100.0, mag_hz=10.0, camera_hz=_PER_S, itinerary=plan
        )
        return Walk(settings, default_rig())

    @property
    def camera(self) -> CameraModel:
        """Of its pictures."""
        camera = self.walk.rig.camera
        assert camera is not None
        return camera

    def T_site_cam(self, frame_id: int) -> Matrix:
        """Return where the camera was, (4, 4), when a picture was taken."""
        return self.walk.T_site_cam(self.walk.frame_times()[frame_id][0])

    def pixel_of(self, point: Vector3, frame_id: int) -> NDArray[np.float64]:
        """Return where in a picture a point was seen."""
        x, y, z, _ = np.linalg.inv(self.T_site_cam(frame_id)) @ (*point, 1.0)
        return np.asarray(lens.project(self.camera, np.array([[x / z, y / z]]))[0])

    def write(self, path: Path) -> None:
        """Write what its sensors said, and what the front end made of pictures that nobody drew."""
        walk = self.walk
        with LogWriter(path, walk.rig, walk.settings.origin, t_start_ns=START_NS) as writer:
            said = (self._misled(m) for m in simulate(walk))
            for measurement in merge(said, self._seen(), key=lambda m: m.t_recv_ns):
                writer.write(measurement)

    def _misled(self, measurement: Measurement) -> Measurement:
        """Return what a compass says whose north is 15 degrees off."""
        if not isinstance(measurement, MagSample):
            return measurement
        c, s = cos(COMPASS_OFF_RAD), sin(COMPASS_OFF_RAD)
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        R_site_body = self.walk.at(np.array([measurement.t_ns])).R_site_body[0]
        x, y, z = (R_site_body.T @ turn @ R_site_body @ measurement.field_body_t).tolist()
        return replace(measurement, field_body_t=(x, y, z))

    def _seen(self) -> Iterator[Frame | VisualMotion]:
        """Yield each picture, empty, and what vision would have made of a real one."""
        source = FeatureCamera(self.camera, _points(), poses_of(self.walk).__getitem__, self.walk.settings.seed)
        front_end = VisionFrontEnd(self.camera, VisionSettings(), source)
        for frame_id, (t_ns, t_recv_ns) in enumerate(self.walk.frame_times()):
            yield Frame(t_ns, t_recv_ns, frame_id, blank_picture())
            motion = front_end.step(Frame(t_ns, t_recv_ns, frame_id, Unseen()))
            if motion is not None:
                yield motion


@contextmanager
def showing_compass_walk(folder: Path) -> Iterator[tuple[Showing, CompassWalk]]:
    """Show it on a server of its own."""
    walk = CompassWalk()
    walk.write(folder / f"{NAME}.mcap")
    settings = ReplaySettings(estimator="camera-gps-imu/precise")
    with Showing(make_site(folder), Log.open(folder / f"{NAME}.mcap"), settings, port=0, web=WEB) as showing:
        yield showing, walk
