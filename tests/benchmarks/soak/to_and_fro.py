"""The demo's walk to and fro for as long as is wanted: its drawn pictures in turn, and sensors that feel that very motion.

Backwards in time positions and attitudes are the same, velocities and turning are mirrored, and accelerations are what they were:
so the way back is a walk as good as the way there. The walker stands still at both ends.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from heapq import merge
from itertools import count
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assets.site import load_site
from assets.terrain import build_terrain
from server.options import SITE
from server.site_tour import tour_of
from server.standing import origin_of
from tracker.gait import Motion
from tracker.log import Log
from tracker.log_writer import LogWriter
from tracker.measurements import Frame, Measurement, TruePose
from tracker.pictures import EncodedPicture
from tracker.simulate import DEMO_WALK, START_NS, SensorNoise, Walk, default_rig, simulate

DEMO = Path(__file__).parents[3] / "assets" / "demo" / "state-agora-walk.mcap"
#: The demo's pictures are 12 a second; this much faster they are 15, and so is the walk.
DRAWN_HZ, CAMERA_HZ = 12.0, 15.0


class ToAndFro(Walk):
    """A walk, there and back again and again."""

    def __init__(
        self, there: Walk, length_s: float, *, faster: float, seconds: float, seed: int, noise: SensorNoise
    ) -> None:
        """Fold a walk.

        Args:
            there: The walk; it stands still at its start and after `length_s`.
            length_s: How much of it is walked.
            faster: Times as fast.
            seconds: How long to go to and fro.
            seed: Of the sensors' noise.
            noise: The sensors' faults.
        """
        self.settings = replace(there.settings, duration_s=seconds, camera_hz=CAMERA_HZ, seed=seed, noise=noise)
        self.rig, self._there, self._length_s, self._faster = there.rig, there, length_s, faster

    def at(self, t_ns: NDArray[np.int64]) -> Motion:
        """Return the motion of the body at (n,) stamps."""
        walked_s = np.asarray(t_ns - START_NS, np.float64) * 1e-9 * self._faster % (2.0 * self._length_s)
        back = walked_s > self._length_s
        place_s = np.where(back, 2.0 * self._length_s - walked_s, walked_s)
        rate = (np.where(back, -1.0, 1.0) * self._faster)[:, None]
        motion = self._there.at(START_NS + (place_s * 1e9).astype(np.int64))
        return Motion(
            motion.p_m, rate * motion.v_m_s, rate**2 * motion.a_m_s2, motion.R_site_body, rate * motion.omega_body_rad_s
        )


@cache
def demo_walk() -> Walk:
    """Return the truth of the demo's walk."""
    site = load_site(SITE)
    settings = replace(DEMO_WALK, tour=tour_of(site), origin=origin_of(site), eye_height_m=site.eye_height_m)
    return Walk(settings, default_rig(), build_terrain(site).ground_z_m)


def sensors(seconds: float, seed: int = 1) -> Iterator[Measurement]:
    """Yield what the sensors say while the demo is walked at the pace of `CAMERA_HZ`; no pictures and no truth."""
    there = demo_walk()
    length_s = (len(there.stamps(DRAWN_HZ)) - 1) / DRAWN_HZ
    faster = CAMERA_HZ / DRAWN_HZ
    walk = ToAndFro(there, length_s, faster=faster, seconds=seconds, seed=seed, noise=there.settings.noise)
    return (measurement for measurement in simulate(walk) if not isinstance(measurement, TruePose))


def frames(pictures: Sequence[EncodedPicture], seconds: float) -> Iterator[Frame]:
    """Yield pictures to and fro, `CAMERA_HZ` of them a second."""
    last = len(pictures) - 1
    late_ns = round(SensorNoise().camera_late_s * 1e9)
    for index in range(int(seconds * CAMERA_HZ)):
        place = index % (2 * last)
        t_ns = START_NS + int(index * (1e9 / CAMERA_HZ))
        yield Frame(t_ns, t_ns + late_ns, index, pictures[min(place, 2 * last - place)])


def demo_pictures() -> list[EncodedPicture]:
    """Return the demo's pictures as JPEG, each compressed once."""
    log = Log.open(DEMO)
    return [EncodedPicture(m.picture.jpeg()) for m in log.messages(truth=False) if isinstance(m, Frame)]


def write_log(path: Path, seconds: float, pictures: Sequence[EncodedPicture]) -> None:
    """Write a log of so long; where it is there already, it is kept."""
    if path.exists():
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + ".part")
    with LogWriter(part, default_rig(), t_start_ns=START_NS, rate_hz=CAMERA_HZ) as writer:
        for measurement in merge(sensors(seconds), frames(pictures, seconds), key=lambda m: m.t_recv_ns):
            writer.write(measurement)
    part.replace(path)


#: Without offsets that are drawn anew each lap: a rig has the same ones all day.
_STEADY = replace(SensorNoise(), gyro_bias_rad_s=0.0, accel_bias_m_s2=0.0, hard_iron_t=0.0)


def endless_sensors() -> Iterator[Measurement]:
    """Yield what the sensors say while the demo is walked to and fro for ever; a lap at a time is in memory."""
    there = demo_walk()
    length_s = (len(there.stamps(DRAWN_HZ)) - 1) / DRAWN_HZ
    lap_ns = round(2e9 * length_s)
    for lap in count():
        walk = ToAndFro(there, length_s, faster=1.0, seconds=2.0 * length_s, seed=lap + 1, noise=_STEADY)
        for measurement in simulate(walk):
            if not isinstance(measurement, TruePose):
                shift_ns = lap * lap_ns
                yield replace(measurement, t_ns=measurement.t_ns + shift_ns, t_recv_ns=measurement.t_recv_ns + shift_ns)
