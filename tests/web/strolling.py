"""A rig without sensors that walks in a circle and tells thirty poses a second, so that where it was at any time is known."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path
from threading import Event, Thread
from time import monotonic_ns

from server.local import LocalServer
from server.messages import ControlReply, ControlRequest
from server.push import RigLink
from server.wire import PoseUpdate, encode_pose
from tests.web.walk import WEB, make_site
from tracker.measurements import Vector3

NAME = "stroll"
ESTIMATOR = "camera-gps-imu/famm"
MOTION_MODEL = "P1R1"
POSE_HZ = 30.0
SPEED_M_S = 1.4
CENTRE_M = (4.0, -28.0)
"""In the open: nothing stands within 25 m."""
RADIUS_M = 4.0
EYES_M = 1.65
SIGMA_M = 0.5


def place_at(t_ns: float) -> Vector3:
    """Return where the rig was, site frame."""
    (east_m, north_m), angle_rad = CENTRE_M, _angle(t_ns)
    return east_m + RADIUS_M * cos(angle_rad), north_m + RADIUS_M * sin(angle_rad), EYES_M


def pose_at(t_ns: int, seq: int) -> PoseUpdate:
    """Return the pose that the rig tells: it looks where it goes."""
    angle_rad = _angle(t_ns)
    yaw_rad = angle_rad + pi / 2.0
    return PoseUpdate(
        seq=seq,
        t_ns=t_ns,
        p_site_body_m=place_at(t_ns),
        wxyz_site_body=(cos(yaw_rad / 2.0), 0.0, 0.0, sin(yaw_rad / 2.0)),
        variance=(SIGMA_M**2, SIGMA_M**2, 1.0, 1e-4, 1e-4, 1e-3),
        v_site_m_s=(-SPEED_M_S * sin(angle_rad), SPEED_M_S * cos(angle_rad), 0.0),
        motion_model=MOTION_MODEL,
    )


def _angle(t_ns: float) -> float:
    return (SPEED_M_S / RADIUS_M * t_ns * 1e-9) % (2.0 * pi)


def _refuse(request: ControlRequest) -> ControlReply:
    return ControlReply(request.request_id, ok=False, error="This rig does nothing that it is asked.")


def standing_at(t_ns: int, seq: int) -> PoseUpdate:
    """Return the pose that a rig tells that stands: it trembles by two millimetres."""
    east_m, north_m, up_m = place_at(0.0)
    place_m = (east_m + 0.002 * sin(seq), north_m + 0.002 * cos(2.0 * seq), up_m)
    return replace(pose_at(0, seq), t_ns=t_ns, p_site_body_m=place_m, v_site_m_s=(0.0, 0.0, 0.0))


@contextmanager
def strolling(
    server: LocalServer, name: str = NAME, told: Callable[[int, int], PoseUpdate] = pose_at
) -> Iterator[RigLink]:
    """Walk until the block ends, or do what else is `told`, by time and number."""
    stop = Event()
    with RigLink(server.rig_url(name), server.rig_token(name), _refuse) as link:
        link.send_state({"kind": "live", "estimator": ESTIMATOR, "estimators": [ESTIMATOR]})

        def walk() -> None:
            seq = 0
            while not stop.wait(1.0 / POSE_HZ):
                link.send_pose(encode_pose(told(monotonic_ns(), seq)))
                seq += 1

        walking = Thread(target=walk, name="stroll", daemon=True)
        walking.start()
        try:
            yield link
        finally:
            stop.set()
            walking.join()


@contextmanager
def serving_square(folder: Path) -> Iterator[LocalServer]:
    """Serve a square of plain volumes where nobody walks yet."""
    with LocalServer(make_site(folder), port=0, web=WEB) as server:
        yield server
