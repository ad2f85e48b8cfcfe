"""How a log is shown: by the best estimator that its sensors allow, through its own camera or a guessed one."""

from dataclasses import replace

from tracker.blank import CAMERA
from tracker.errors import MalformedInput
from tracker.estimators import DEFAULT_ESTIMATOR, missing_sensors
from tracker.log import Log
from tracker.measurements import Frame
from tracker.rig import Rig, guessed_camera

#: The best first: what plays when nothing was chosen.
PREFERENCE = (DEFAULT_ESTIMATOR, "gps-imu/precise", "truth")


def best_estimator(log: Log) -> str:
    """Return the best that a log's sensors allow.

    What nobody can place on the square plays as its truth, or not at all: the last name then says what is missing.
    """
    info, rig = log.info, log.rig
    placed = [name for name in PREFERENCE if name == "truth" or info.counts["gps"] > 0]
    return next((name for name in placed if missing_sensors(name, info, rig) is None), "gps-imu/famm")


def display_rig(log: Log) -> Rig:
    """Return a rig that a picture can be drawn with: an unknown camera is guessed from the size of its first picture."""
    if log.rig.camera is not None:
        return log.rig
    if not log.info.counts["frames"]:
        return replace(log.rig, camera=CAMERA)
    for measurement in log.messages(truth=False):
        if isinstance(measurement, Frame):
            try:
                height_px, width_px = measurement.picture.gray().shape
            except MalformedInput:
                continue
            return replace(log.rig, camera=guessed_camera(width_px, height_px))
    return replace(log.rig, camera=CAMERA)
