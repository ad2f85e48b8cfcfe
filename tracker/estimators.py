"""The estimators by name: how each is built, and which sensors it cannot do without."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from tracker.errors import UnknownEstimator
from tracker.estimator import Estimator, Origin
from tracker.geodesy import SiteFrame
from tracker.geomagnetism import MagneticField
from tracker.motion import (
    AutomatonMotion,
    ConstantMotion,
    FuzzyMotion,
    InteractingMotion,
    MotionSelector,
    ReducedMotion,
)
from tracker.paper import PaperEstimator, PaperSettings
from tracker.precise.compass import Compass
from tracker.precise.estimator import PreciseEstimator
from tracker.precise.ground import EyeHeight
from tracker.precise.memory import Memory
from tracker.precise.settings import PreciseSettings
from tracker.rig import Rig
from tracker.truth import TruthEstimator

#: Who may choose the motion model: the paper's two, and their rivals.
SELECTORS: dict[str, type[MotionSelector]] = {
    "cmm": ConstantMotion,
    "famm": FuzzyMotion,
    "dfa": AutomatonMotion,
    "imm": InteractingMotion,
    "reduced": ReducedMotion,
}
SENSORS = ("gps-imu", "camera-gps-imu")

PRECISE = "precise"

ESTIMATORS: tuple[str, ...] = (
    *(f"{sensors}/{selector}" for sensors in SENSORS for selector in (*SELECTORS, PRECISE)),
    "truth",
)
DEFAULT_ESTIMATOR = "camera-gps-imu/precise"


@dataclass(frozen=True)
class Settings:
    """Settings of every estimator."""

    paper: PaperSettings = field(default_factory=PaperSettings)
    precise: PreciseSettings = field(default_factory=PreciseSettings)


class Contents(Protocol):
    """What must be known of a log or a rig to say which estimators it can feed."""

    @property
    def counts(self) -> dict[str, int]:
        """Messages by sensor."""
        ...

    @property
    def has_truth(self) -> bool:
        """Whether there is ground truth."""
        ...


def build(
    name: str,
    *,
    origin: Origin,
    rig: Rig,
    declination_rad: float,
    truth_origin: Origin | None = None,
    settings: Settings | None = None,
    earth_field: MagneticField | None = None,
    eyes_z_m: EyeHeight | None = None,
    memory: Memory | None = None,
) -> Estimator:
    """Return a new estimator.

    Args:
        name: One of `ESTIMATORS`.
        origin: Where the site frame is laid; all poses are in it.
        rig: Extrinsics and camera.
        declination_rad: East of true north, for the magnetometer.
        truth_origin: Where the log's map frame is laid; None where it is the site's.
        settings: None for the defaults.
        earth_field: What a magnetometer should measure there; None where nobody knows, and then every field is believed.
        eyes_z_m: Height of the rig in site where it stands on the ground, which `precise` asks for; None where no ground is known.
        memory: What the same rig had learned at its last start, which `precise` takes up; None where nothing is known.

    Raises:
        UnknownEstimator: No estimator has that name.
    """
    check_name(name)
    if name == "truth":
        return TruthEstimator(SiteFrame(origin).T_from(truth_origin) if truth_origin else np.eye(4))
    sensors, kind = name.rsplit("/", 1)
    uses_camera, settings = sensors.startswith("camera"), settings or Settings()
    if kind == PRECISE:
        return PreciseEstimator(
            name,
            origin=origin,
            rig=rig,
            compass=Compass(declination_rad, earth_field),
            uses_camera=uses_camera,
            settings=settings.precise,
            eyes_z_m=eyes_z_m,
            memory=memory,
        )
    return PaperEstimator(
        name,
        SELECTORS[kind].of(settings.paper.fuzzy),
        origin=origin,
        rig=rig,
        declination_rad=declination_rad,
        uses_camera=uses_camera,
        settings=settings.paper,
    )


def check_name(name: str) -> None:
    """Raise `UnknownEstimator` unless an estimator has that name."""
    if name not in ESTIMATORS:
        raise UnknownEstimator(f"There is no estimator {name!r}: choose one of {', '.join(ESTIMATORS)}.")


def missing_sensors(name: str, contents: Contents, rig: Rig) -> str | None:
    """Return in words what an estimator lacks, or None where it can run."""
    check_name(name)
    if name == "truth":
        return None if contents.has_truth else "no ground truth"
    counts = contents.counts
    missing = [
        words
        for words, is_there in (
            ("no IMU", counts.get("imu", 0) > 0),
            # without a receiver the precise one is an attitude filter
            ("no GPS", counts.get("gps", 0) > 0 or name.endswith(PRECISE)),
            ("no camera", not name.startswith("camera") or counts.get("frames", 0) > 0),
            ("no camera calibration", not name.startswith("camera") or not counts.get("frames", 0) or rig.camera),
        )
        if not is_there
    ]
    return ", ".join(missing) or None
