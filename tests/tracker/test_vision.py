"""The camera's front end on pictures whose motion is known: a textured wall seen by a camera that turns and moves."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from tracker.geometry import exp as wxyz_of
from tracker.geometry import matrix_from_wxyz
from tracker.measurements import Frame, Image, Matrix, Picture, Vector3, VisualMotion
from tracker.pictures import ArrayPicture, EncodedPicture
from tracker.rig import CameraModel
from tracker.vision import VisionFrontEnd

CAMERA = CameraModel(320, 240, 280.0, 280.0, 159.5, 119.5)
PERIOD_NS = 80_000_000
#: Walls one before the other: each hides the lower part of those behind it from this row of its texture on.
WALLS = ((9.0, 0), (5.0, 420), (3.0, 500))


def _texture(seed: int, depth_m: float) -> Image:
    """Spots that look equally large at every depth, so that every wall has its share of features."""
    shape = (round(900 / (3.5 * depth_m)), round(1200 / (3.5 * depth_m)))
    noise = np.random.default_rng(seed).integers(0, 255, shape, np.uint8)
    return np.asarray(cv2.resize(noise, (1200, 900), interpolation=cv2.INTER_CUBIC), np.uint8)


def _picture(R_world_cam: Matrix, p_world_m: Vector3) -> ArrayPicture:
    """Planes z = const, 100 px to the metre, centred ahead."""
    size = (CAMERA.width_px, CAMERA.height_px)
    picture = np.zeros((CAMERA.height_px, CAMERA.width_px, 3), np.uint8)
    px, py, pz = p_world_m
    for number, (depth_m, first_row) in enumerate(WALLS):
        # pixel = K R^T (X - p), X = ((u - 600) / 100, (v - 450) / 100, depth)
        plane = np.array([[0.01, 0.0, -6.0 - px], [0.0, 0.01, -4.5 - py], [0.0, 0.0, depth_m - pz]])
        H = CAMERA.K @ R_world_cam.T @ plane
        texture = cv2.cvtColor(_texture(number, depth_m), cv2.COLOR_GRAY2BGR)
        mask = np.zeros(texture.shape[:2], np.uint8)
        mask[first_row:] = 255
        wall, seen = cv2.warpPerspective(texture, H, size), cv2.warpPerspective(mask, H, size)
        picture = np.where(seen[:, :, None] > 127, wall, picture).astype(np.uint8)
    return ArrayPicture(picture)


def _run(turn_rad: Vector3, step_m: Vector3, count: int = 12) -> list[VisualMotion]:
    front_end, found = VisionFrontEnd(CAMERA), []
    for index in range(count):
        rx, ry, rz = (angle * index for angle in turn_rad)
        x, y, z = (part * index for part in step_m)
        picture = _picture(matrix_from_wxyz(wxyz_of((rx, ry, rz))), (x, y, z))
        motion = front_end.step(Frame(index * PERIOD_NS, index * PERIOD_NS, index, picture))
        if motion is not None:
            found.append(motion)
    return found


def _expected(motion: VisualMotion, turn_rad: Vector3) -> Matrix:
    frames = (motion.t_ns - motion.t_key_ns) / PERIOD_NS
    return matrix_from_wxyz(wxyz_of((turn_rad[0] * frames, turn_rad[1] * frames, turn_rad[2] * frames)))


@pytest.mark.parametrize("turn", [(0.0, 0.02, 0.0), (0.01, 0.0, 0.02)])
def test_a_turn_on_the_spot(turn: Vector3) -> None:
    """Within a sixth of a degree, and without a direction of travel."""
    motions = _run(turn, (0.0, 0.0, 0.0))
    assert len(motions) >= 10
    for motion in motions:
        off = motion.R_key_cam.T @ _expected(motion, turn)
        assert np.degrees(np.arccos(np.clip((np.trace(off) - 1) / 2, -1, 1))) < 0.17
        assert motion.direction_key == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("step", "turn"), [((0.06, 0.0, 0.0), (0.0, 0.0, 0.0)), ((0.0, 0.0, 0.12), (0.0, 0.004, 0.0))])
def test_a_translation_has_its_direction(step: Vector3, turn: Vector3) -> None:
    """Sideways and forwards (turning a little): within 20 degrees where parallax is enough, and not backwards."""
    motions = [m for m in _run(turn, step) if m.parallax_px > 5.0 and m.direction_key != (0.0, 0.0, 0.0)]
    assert len(motions) >= 3
    for motion in motions:
        key_turn = (motion.t_key_ns / PERIOD_NS) * turn[1]
        world = np.array(step) / np.linalg.norm(step)
        expected = matrix_from_wxyz(wxyz_of((0.0, key_turn, 0.0))).T @ world
        assert float(np.dot(expected, motion.direction_key)) > np.cos(np.radians(20.0))
        assert motion.inliers >= 30


def test_features_keep_their_numbers_from_keyframe_to_keyframe() -> None:
    """Where one is seen again it was told last, and all follow one wall or another as the camera goes aside."""
    keys = [m for m in _run((0.0, 0.0, 0.0), (0.06, 0.0, 0.0), count=40) if m.is_keyframe]
    assert len(keys) >= 3
    for before, now in pairwise(keys):
        assert before.tracks is not None
        assert now.tracks is not None
        assert now.t_key_ns == before.t_ns
        assert len(now.tracks.ids) == now.inliers == len(set(now.tracks.ids.tolist()))
        _, then, there = np.intersect1d(before.tracks.ids, now.tracks.ids, return_indices=True)
        assert len(then) > 30
        np.testing.assert_allclose(before.tracks.xy[then], now.tracks.xy_key[there], atol=1e-6)
        moved_m = 0.06 * (now.t_ns - now.t_key_ns) / PERIOD_NS
        depth_m = moved_m / np.maximum(1e-3, now.tracks.xy_key[:, 0] - now.tracks.xy[:, 0])
        nearest = np.abs(depth_m[:, None] / np.array([wall for wall, _ in WALLS]) - 1.0).min(axis=1)
        assert np.median(nearest) < 0.1


def test_features_are_told_between_keyframes_too() -> None:
    """Three pictures long, or four, after they were told last; each time beside the same places in the keyframe."""
    motions = _run((0.0, 0.0, 0.0), (0.02, 0.0, 0.0), count=40)
    told = [m for m in motions if m.tracks is not None]
    assert all(m.tracks is not None for m in motions if m.is_keyframe)
    assert told[0].is_keyframe or told[0].t_ns - told[0].t_key_ns >= 0.3e9
    between = [(a, b) for a, b in pairwise(told) if a.t_key_ns == b.t_key_ns]
    assert len(between) >= 3
    for before, now in pairwise(told):
        assert now.is_keyframe or 0.3e9 <= now.t_ns - before.t_ns <= 0.3e9 + PERIOD_NS
    for before, now in between:
        assert before.tracks is not None
        assert now.tracks is not None
        _, then, there = np.intersect1d(before.tracks.ids, now.tracks.ids, return_indices=True)
        assert len(then) > 30
        np.testing.assert_array_equal(before.tracks.xy_key[then], now.tracks.xy_key[there])


def test_what_cannot_be_tracked_gives_nothing() -> None:
    """Darkness, bytes that are no picture, a picture from the past, a jump in time, another size: None, and it goes on."""
    front_end = VisionFrontEnd(CAMERA)
    good = _picture(np.eye(3), (0.0, 0.0, 0.0))
    dark = ArrayPicture(np.zeros((240, 320, 3), np.uint8))
    small = ArrayPicture(good.pixels[::2, ::2].copy())
    pictures: list[tuple[int, Picture]] = [
        (0, good), (1, EncodedPicture(b"no picture")), (1, dark), (2, dark), (3, good), (2, good), (40, good), (41, small),
    ]  # fmt: skip
    for number, picture in pictures:
        assert front_end.step(Frame(number * PERIOD_NS, number * PERIOD_NS, number, picture)) is None
    after = front_end.step(Frame(42 * PERIOD_NS, 42 * PERIOD_NS, 42, small))
    assert after is not None
    assert after.t_key_ns == 41 * PERIOD_NS


def test_a_snapshot_is_exact() -> None:
    """What follows a restore is what followed the snapshot."""
    frames = [Frame(i * PERIOD_NS, i * PERIOD_NS, i, _picture(np.eye(3), (0.06 * i, 0.0, 0.0))) for i in range(8)]
    front_end = VisionFrontEnd(CAMERA)
    for frame in frames[:4]:
        front_end.step(frame)
    snapshot = front_end.snapshot()
    first = [front_end.step(frame) for frame in frames[4:]]
    front_end.restore(snapshot)
    for a, b in zip(first, [front_end.step(frame) for frame in frames[4:]], strict=True):
        assert a is not None
        assert b is not None
        assert a.direction_key == b.direction_key
        np.testing.assert_array_equal(a.R_key_cam, b.R_key_cam)
