"""What stands in front of the model today hides it: every pixel, and with edges as soft as the pose is uncertain."""

import struct
from collections.abc import Iterator

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from assets.gltf import Node, Scene
from assets.prisms import indexed_mesh
from assets.walkable import WHITE
from server.showing import Showing
from tests.web.pages import SIZE_PX, ArPage, Pixels, open_page
from tests.web.tampering import Tampering
from tests.web.walk import make_walk, position_of, showing_walk

pytestmark = pytest.mark.browser

FRAME = 25
WALL_CAM_M = np.array([[x, y, 8.0] for x, y in ((-5.0, -2.5), (1.0, -2.5), (1.0, 1.0), (-5.0, 1.0))])
"""Corners of a wall 8 m ahead, in the camera's frame: above the ground, from left of the picture to right of its middle."""
COVARIANCE = 160
"""Where it begins in a frame message."""
EDGE_PX = 2
"""A pixel that the wall covers in part shows the model in part."""
PLAIN_DIFFERENCE = 1
"""Of 255: the picture as it was."""

Mask = NDArray[np.bool_]


@pytest.fixture(scope="module")
def showing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Showing]:
    """The walk on a server, with a wall where the camera of one picture looks."""
    T_site_cam = make_walk().T_site_cam(make_walk().frame_times()[FRAME][0])
    corners = WALL_CAM_M @ T_site_cam[:3, :3].T + T_site_cam[:3, 3]
    mesh = indexed_mesh(corners, np.array([[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]]))
    wall = Scene([Node("wall", [mesh], {"role": "occluder"})], {mesh.material: WHITE})
    with showing_walk(tmp_path_factory.mktemp("occlusion"), wall) as showing:
        yield showing


@pytest.fixture
def ar(browser: Browser) -> Iterator[ArPage]:
    """An empty page."""
    with open_page(browser) as page:
        yield page
        assert page.errors == []


def stand(ar: ArPage, showing: Showing) -> None:
    """Show the picture that looks at the wall, with targets in a grid 30 m ahead of it."""
    ar.page.goto(f"{showing.url}ar?effort=soft+edges")
    ar.until_drawn()
    if ar.ask("agora.session().playback.playing"):
        ar.pause()
    ar.seek(position_of(FRAME))
    ar.until(f"agora.stats().lastFrameId === {FRAME} && agora.stats().occluders")


def wall_mask(grown_px: int) -> Mask:
    """Return which pixels the wall covers, by OpenCV; grown or, where negative, shrunk."""
    camera = make_walk().rig.camera
    assert camera is not None
    K = np.array([[camera.fx_px, 0.0, camera.cx_px], [0.0, camera.fy_px, camera.cy_px], [0.0, 0.0, 1.0]])
    outline = np.concatenate(
        [np.linspace(a, b, 60) for a, b in zip(WALL_CAM_M, np.roll(WALL_CAM_M, -1, 0), strict=True)]
    )
    seen, _ = cv2.projectPoints(outline, np.zeros(3), np.zeros(3), K, np.array(camera.distortion))
    mask = np.zeros(SIZE_PX[::-1], np.uint8)
    cv2.fillPoly(mask, [np.round(seen.reshape(-1, 2)).astype(np.int32)], (255,))
    kernel = np.ones((2 * abs(grown_px) + 1,) * 2, np.uint8)
    return np.asarray((cv2.dilate if grown_px > 0 else cv2.erode)(mask, kernel) > 0, bool)


def with_targets(ar: ArPage) -> tuple[Pixels, Pixels]:
    """Return the picture alone, and with the model and a grid of targets beyond the wall that it may hide."""
    ar.ask("agora.setPast(0)")
    plain = ar.pixels()
    x, y = np.meshgrid(np.linspace(-18.0, 18.0, 41), np.linspace(-12.0, 1.0, 17))
    grid = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 30.0)])
    T_site_cam = np.array(ar.ask("agora.pose().T_site_cam")).reshape(4, 4)
    points = grid @ T_site_cam[:3, :3].T + T_site_cam[:3, 3]
    ar.ask("(points) => agora.debugTargets(points, points.map(() => '#ff00ff'), true)", points.tolist())
    return plain, ar.pixels()


def changed(a: Pixels, b: Pixels) -> NDArray[np.int64]:
    """Return by how much pixels differ, the most of three colours."""
    return np.asarray(np.abs(a.astype(int) - b).max(axis=-1))


def test_nothing_is_seen_through_what_stands_today(ar: ArPage, showing: Showing) -> None:
    stand(ar, showing)
    plain, drawn = with_targets(ar)
    behind, beside = wall_mask(-EDGE_PX), ~wall_mask(EDGE_PX)
    assert 0.15 < behind.mean() < 0.8
    assert (changed(plain, drawn)[behind] <= PLAIN_DIFFERENCE).all()
    magenta = (drawn[..., 0] > 200) & (drawn[..., 1] < 90) & (drawn[..., 2] > 200)
    assert magenta[beside].sum() > 500
    assert (changed(plain, drawn)[beside] > 12).mean() > 0.3


def test_edges_are_as_soft_as_the_pose_is_uncertain(ar: ArPage, showing: Showing) -> None:
    sigmas = (0.3, 0.3, 0.3, 0.003, 0.003, 0.02)
    upper = [sigmas[i] ** 2 if i == j else 0.0 for i in range(6) for j in range(i, 6)]
    Tampering(ar.page, COVARIANCE, struct.pack("<21f", *upper), every=1)
    stand(ar, showing)
    assert ar.stats()["overlay"] == "locked"
    plain, soft = with_targets(ar)
    assert (changed(plain, soft)[wall_mask(-EDGE_PX)] <= PLAIN_DIFFERENCE).all()
    rows = slice(160, 200)
    right_edge = int(np.flatnonzero(wall_mask(0)[180])[-1])
    near, far = (changed(plain, soft)[rows, right_edge + a : right_edge + b].mean() for a, b in ((3, 7), (60, 120)))
    assert near < 0.5 * far
    assert far > 12.0
