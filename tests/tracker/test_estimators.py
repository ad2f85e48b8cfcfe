"""Estimators by name, and what each cannot do without."""

from dataclasses import dataclass, field

import pytest

from tracker.errors import UnknownEstimator
from tracker.estimators import DEFAULT_ESTIMATOR, ESTIMATORS, build, check_name, missing_sensors
from tracker.rig import CameraModel, Rig
from tracker.simulate import AGORA_ORIGIN

CAMERA = CameraModel(64, 48, 60.0, 60.0, 31.5, 23.5)


@dataclass
class Contents:
    """What a log says that it holds."""

    counts: dict[str, int] = field(default_factory=dict)
    has_truth: bool = False


@pytest.mark.parametrize("name", ESTIMATORS)
def test_each_is_built_under_its_name(name: str) -> None:
    """Those whose name begins with camera want pictures; none has a pose before it has seen anything."""
    estimator = build(name, origin=AGORA_ORIGIN, rig=Rig(camera=CAMERA), declination_rad=0.0)
    assert estimator.name == name
    assert estimator.uses_camera == name.startswith("camera")
    assert estimator.predict(0) is None
    assert estimator.innovations() == []


def test_the_default_is_one_of_them() -> None:
    """And the paper's four columns are there."""
    assert DEFAULT_ESTIMATOR in ESTIMATORS
    assert {"gps-imu/cmm", "gps-imu/famm", "camera-gps-imu/cmm", "camera-gps-imu/famm", "truth"} <= set(ESTIMATORS)


@pytest.mark.parametrize(
    ("name", "contents", "camera", "words"),
    [
        ("truth", Contents(), None, "no ground truth"),
        ("truth", Contents(has_truth=True), None, None),
        ("gps-imu/famm", Contents({"imu": 9, "gps": 9}), None, None),
        ("gps-imu/famm", Contents({"imu": 9, "gps": 0}), None, "no GPS"),
        ("gps-imu/cmm", Contents({"gps": 9}), None, "no IMU"),
        ("camera-gps-imu/cmm", Contents({"imu": 9}), None, "no GPS, no camera"),
        ("gps-imu/precise", Contents({"imu": 9}), None, None),
        ("gps-imu/precise", Contents({"gps": 9, "mag": 9}), None, "no IMU"),
        ("camera-gps-imu/precise", Contents({"imu": 9, "gps": 9}), CAMERA, "no camera"),
        ("camera-gps-imu/precise", Contents({"frames": 9, "gps": 9}), CAMERA, "no IMU"),
        ("camera-gps-imu/precise", Contents({"imu": 9, "frames": 9}), CAMERA, None),
        ("camera-gps-imu/cmm", Contents({"imu": 9, "gps": 9, "frames": 9}), None, "no camera calibration"),
        ("camera-gps-imu/cmm", Contents({"imu": 9, "gps": 9, "frames": 9}), CAMERA, None),
    ],
)
def test_what_is_missing_is_put_in_words(
    name: str, contents: Contents, camera: CameraModel | None, words: str | None
) -> None:
    """One phrase that completes "it has"; None where nothing is missing."""
    assert missing_sensors(name, contents, Rig(camera=camera)) == words


def test_names_are_checked() -> None:
    """The message lists the names."""
    with pytest.raises(UnknownEstimator, match=r"'kalman'.*gps-imu/famm"):
        check_name("kalman")
