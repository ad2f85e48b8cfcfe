"""Chunks: every triangle is in one, and a picture leaves out only what it cannot show."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from assets.chunks import CELL_M, chunked, seen
from assets.lens import Pinhole

CAMERA = Pinhole(320, 240, 260.0, 260.0, 158.0, 121.0)
RNG = np.random.default_rng(8)
POSITIONS = np.repeat(RNG.uniform((-200, -200, 0), (200, 200, 20), (900, 3)), 3, axis=0) + RNG.normal(0, 1, (2700, 3))
TRIANGLES = np.arange(2700, dtype=np.uint32).reshape(-1, 3)


def test_every_triangle_is_in_one_chunk() -> None:
    ordered, chunks = chunked(POSITIONS.astype(np.float32), TRIANGLES)
    assert sorted(ordered[:, 0].tolist()) == TRIANGLES[:, 0].tolist()
    assert [chunk.first for chunk in chunks] == np.cumsum([0] + [chunk.count for chunk in chunks[:-1]]).tolist()
    assert sum(chunk.count for chunk in chunks) == ordered.size
    for chunk in chunks:
        points = POSITIONS[ordered.ravel()[chunk.first : chunk.first + chunk.count]]
        assert np.linalg.norm(points - chunk.middle_m, axis=1).max() <= chunk.radius_m + 1e-4
        assert chunk.radius_m < 2.0 * CELL_M


@settings(max_examples=30, deadline=None)
@given(e=st.floats(-150, 150), n=st.floats(-150, 150), yaw=st.floats(-3.1, 3.1), tilt=st.floats(-0.5, 0.5))
def test_what_a_picture_shows_is_never_left_out(e: float, n: float, yaw: float, tilt: float) -> None:
    ordered, chunks = chunked(POSITIONS.astype(np.float32), TRIANGLES)
    level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    nod = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(tilt), -np.sin(tilt)], [0.0, np.sin(tilt), np.cos(tilt)]])
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn @ level @ nod, (e, n, 1.65)
    inverse = np.linalg.inv(pose).astype(np.float64)
    local = POSITIONS @ inverse[:3, :3].T + inverse[:3, 3]
    x = CAMERA.fx_px * local[:, 0] / local[:, 2] + CAMERA.cx_px
    y = CAMERA.fy_px * local[:, 1] / local[:, 2] + CAMERA.cy_px
    inside = (local[:, 2] > 0.0) & (x > -0.5) & (x < 319.5) & (y > -0.5) & (y < 239.5)
    drawn = seen(chunks, inverse, CAMERA)
    kept = {int(i) for _, chunk in drawn for i in ordered.ravel()[chunk.first : chunk.first + chunk.count]}
    assert set(np.flatnonzero(inside).tolist()) <= kept
    assert len(drawn) < len(chunks)
