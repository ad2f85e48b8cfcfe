"""A camera without pictures, in a world of points: faultless it is a projection, and faults are of the size that is asked for."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from tracker import lens
from tracker.feature_camera import Faults, FeatureCamera
from tracker.features import NO_FEATURES, Features
from tracker.geometry import exp as wxyz_of
from tracker.geometry import matrix_from_wxyz
from tracker.measurements import Frame, Image, Matrix
from tracker.rig import CameraModel
from tracker.vision import VisionFrontEnd

CAMERA = CameraModel(640, 480, 520.0, 520.0, 321.3, 238.6, "plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0))
PERIOD_NS = 80_000_000
FAULTLESS = replace(Faults(**dict.fromkeys(Faults.__dataclass_fields__, 0.0)), kept_share=1.0)


@dataclass(frozen=True)
class Points:
    """Corners anywhere."""

    p_site_m: Matrix
    strength: Matrix
    on_rim: NDArray[np.bool_]

    def corners(self, p_site_m: Matrix) -> "Points":
        return self


class NoPicture:
    """Fails whoever looks at it."""

    def gray(self) -> Image:
        raise AssertionError("a feature camera has no pictures")

    def jpeg(self) -> bytes:
        raise AssertionError("a feature camera has no pictures")


def _world(count: int = 6000, rim_share: float = 0.0, size_m: float = 40.0) -> Points:
    """Points all about; the camera looks along z."""
    rng = np.random.default_rng(5)
    points = rng.uniform(-size_m, size_m, (count, 3))
    return Points(points, np.sort(rng.uniform(0.1, 1.0, count))[::-1], rng.random(count) < rim_share)


def _pose(t_ns: int) -> Matrix:
    """Turning slowly while it goes sideways."""
    steps = t_ns / PERIOD_NS
    pose = np.eye(4)
    pose[:3, :3] = matrix_from_wxyz(wxyz_of((0.0, 0.01 * steps, 0.0)))
    pose[0, 3] = 0.05 * steps
    return pose


def _frame(number: int) -> Frame:
    return Frame(number * PERIOD_NS, number * PERIOD_NS, number, NoPicture())


def _camera(faults: Faults = FAULTLESS, world: Points | None = None, seed: int = 1) -> FeatureCamera:
    return FeatureCamera(CAMERA, world or _world(), _pose, seed, faults)


def _sideways(t_ns: int) -> Matrix:
    """Half a metre to the right with each picture."""
    pose = np.eye(4)
    pose[0, 3] = 0.5 * (t_ns / PERIOD_NS)
    return pose


def _detected(source: FeatureCamera) -> Features:
    return source.detect(source.look(_frame(0)), NO_FEATURES, 400, 5)


def test_features_are_corners_where_the_lens_throws_them() -> None:
    source = _camera()
    features = _detected(source)
    assert len(features) > 100
    xy = features.marks[:, :2] / features.marks[:, 2:3]
    np.testing.assert_allclose(features.points_px, lens.project(CAMERA, xy), atol=1e-3)
    assert (features.marks[:, 2] > 0.0).all()
    assert ((features.points_px >= 0.0) & (features.points_px <= (639.0, 479.0))).all()


def test_the_strongest_come_first_and_keep_their_distance() -> None:
    source = _camera()
    view = source.look(_frame(0))
    first = source.detect(view, NO_FEATURES, 60, 18)
    more = source.detect(view, first, 500, 18)
    both = first.joined(more).points_px
    apart_px = np.linalg.norm(both[:, None] - both[None], axis=2) + 1e3 * np.eye(len(both))
    # a place is held by its nearest pixel
    assert apart_px.min() > 18.0 - 2.0 * np.hypot(0.5, 0.5)
    strength = {tuple(p): s for p, s in zip(_world().p_site_m.tolist(), _world().strength.tolist(), strict=True)}
    assert min(strength[tuple(m)] for m in first.marks[:, :3].tolist()) > max(
        strength[tuple(m)] for m in more.marks[:, :3].tolist()
    )


def test_without_faults_features_go_with_their_corners() -> None:
    source = _camera()
    features = _detected(source)
    there, kept = source.follow(source.look(_frame(0)), source.look(_frame(4)), features)
    R, p = _pose(4 * PERIOD_NS)[:3, :3], _pose(4 * PERIOD_NS)[:3, 3]
    seen = (there.marks[:, :3] - p) @ R
    np.testing.assert_allclose(there.points_px, lens.project(CAMERA, seen[:, :2] / seen[:, 2:]), atol=2e-3)
    assert 0.5 * len(features) < len(there) < len(features)
    # only those that left the picture are gone
    gone = (features.marks[~kept, :3] - p) @ R
    px = lens.project(CAMERA, gone[:, :2] / gone[:, 2:])
    assert ((px < 0.0) | (px > (639.0, 479.0)) | (gone[:, 2:] < 0.2)).any(axis=1).all()


def _still(faults: Faults, rim_share: float) -> tuple[Features, Features, NDArray[np.bool_]]:
    source = replace(_camera(faults, _world(60_000, rim_share)), T_site_cam=lambda t_ns: np.eye(4))
    features = source.detect(source.look(_frame(0)), NO_FEATURES, 4000, 1)
    assert len(features) > 2000
    there, kept = source.follow(source.look(_frame(0)), source.look(_frame(1)), features)
    return features, there, kept


def test_drift_and_slips_are_of_the_size_asked_for() -> None:
    features, there, kept = _still(replace(FAULTLESS, drift_px=0.3), 0.0)
    off_px = there.points_px - features.chosen(kept).points_px
    assert np.std(off_px) == pytest.approx(0.3, rel=0.05)
    features, there, kept = _still(replace(FAULTLESS, slip_rate=0.2, slip_px=3.0), 0.0)
    off_px = there.points_px - features.chosen(kept).points_px
    slipped = np.abs(off_px).max(axis=1) > 1e-3
    assert np.mean(slipped) == pytest.approx(0.2, abs=0.03)
    assert np.mean(np.abs(off_px[slipped])) == pytest.approx(3.0, rel=0.12)


def test_a_still_camera_drifts_nowhere_and_a_fast_one_more() -> None:
    features, there, kept = _still(Faults(border_loss=0.0), 1.0)
    assert kept.all()
    np.testing.assert_allclose(there.points_px, features.points_px, atol=1e-3)
    source = _camera(replace(FAULTLESS, drift_per_px=0.01, fast_px=10.0))
    spread = []
    for steps in (1, 8):
        there, _ = source.follow(source.look(_frame(0)), source.look(_frame(steps)), _detected(source))
        exact, _ = _camera().follow(source.look(_frame(0)), source.look(_frame(steps)), _detected(source))
        both = {tuple(m): p for m, p in zip(exact.marks[:, :3].tolist(), exact.points_px, strict=True)}
        off_px = [
            p - both[k]
            for m, p in zip(there.marks.tolist(), there.points_px, strict=True)
            if (k := tuple(m[:3])) in both
        ]
        spread.append(float(np.std(off_px)))
    # eight steps are 42 px and more of turning
    assert spread[0] < 0.01
    assert spread[1] > 0.3


def test_fast_corners_and_those_at_the_border_are_lost() -> None:
    features, _, kept = _still(replace(FAULTLESS, border_px=60.0, border_loss=0.4), 0.0)
    x, y = features.points_px.T
    inside = (x >= 60.0) & (x <= 579.0) & (y >= 60.0) & (y <= 419.0)
    assert kept[inside].all()
    assert np.mean(kept[~inside]) == pytest.approx(0.6, abs=0.05)
    source = _camera(replace(FAULTLESS, loss_at_px=80.0, loss_power=2.0))
    views = [source.look(_frame(number)) for number in (0, 4, 8)]
    survivors = [len(source.follow(views[0], view, _detected(source))[0]) for view in views]
    sure = [len(_camera().follow(views[0], view, _detected(source))[0]) for view in views]
    assert survivors[0] == sure[0]
    # about (21 / 80)^2 and (42 / 80)^2, and more where the corners are near
    assert 0.8 < survivors[1] / sure[1] < 0.97
    assert 0.5 < survivors[2] / sure[2] < 0.8


def test_what_is_on_a_rim_slides_with_the_parallax() -> None:
    """And nothing else does: by its share of it in the median, whichever way."""
    world = _world(60_000, 0.5)
    source = replace(_camera(replace(FAULTLESS, slide=0.1, slide_spread=0.3), world), T_site_cam=_sideways)
    features = source.detect(source.look(_frame(0)), NO_FEATURES, 4000, 1)
    there, _ = source.follow(source.look(_frame(0)), source.look(_frame(1)), features)
    seen = there.marks[:, :3] - _sideways(PERIOD_NS)[:3, 3]
    off_px = np.linalg.norm(there.points_px - lens.project(CAMERA, seen[:, :2] / seen[:, 2:]), axis=1)
    parallax_px = 520.0 * 0.5 / np.linalg.norm(seen, axis=1)
    on_rim = (there.marks[:, 3:] != 0.0).any(axis=1)
    slid, other = off_px[on_rim] / parallax_px[on_rim], off_px[~on_rim]
    assert len(slid) > 1000
    assert np.median(slid) == pytest.approx(0.1, rel=0.06)
    assert other.max() < 0.01
    assert 0.45 < np.mean(on_rim) < 0.55


def test_drift_adds_up() -> None:
    """A feature that went astray goes on from there: its error after n steps is the square root of n times that of one."""
    source = replace(_camera(replace(FAULTLESS, drift_px=0.1)), T_site_cam=lambda t_ns: np.eye(4))
    start = _detected(source)
    features = start
    for number in range(25):
        features, _ = source.follow(source.look(_frame(number)), source.look(_frame(number + 1)), features)
    off_px = {tuple(m): p for m, p in zip(start.marks[:, :3].tolist(), start.points_px, strict=True)}
    moved = np.array(
        [p - off_px[tuple(m)] for m, p in zip(features.marks[:, :3].tolist(), features.points_px, strict=True)]
    )
    assert np.std(moved) == pytest.approx(0.5, rel=0.12)


def test_the_front_end_finds_the_motion_without_a_picture() -> None:
    """Rotation and direction against truth, the same twice, others for another seed."""
    runs = []
    for seed in (1, 1, 2):
        front_end = VisionFrontEnd(CAMERA, source=_camera(Faults(), _world(size_m=10.0), seed))
        runs.append([motion for motion in map(front_end.step, map(_frame, range(20))) if motion is not None])
    first, again, other = runs
    assert len(first) >= 18
    assert any(motion.is_keyframe for motion in first)
    told = [motion for motion in first if any(motion.direction_key)]
    assert len(told) >= 5
    for motion in told:
        off = motion.R_key_cam.T @ _pose(motion.t_key_ns)[:3, :3].T @ _pose(motion.t_ns)[:3, :3]
        assert np.degrees(np.arccos(np.clip((np.trace(off) - 1.0) / 2.0, -1.0, 1.0))) < 0.3
        assert (_pose(motion.t_key_ns)[:3, :3] @ np.array(motion.direction_key))[0] > np.cos(np.radians(15.0))
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a.R_key_cam, b.R_key_cam)
    assert any((a.R_key_cam != b.R_key_cam).any() for a, b in zip(first, other, strict=False))
