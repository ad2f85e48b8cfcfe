"""Where the page draws: footprint corners of five monuments, beside a rendering of the same corners that knows nothing of the page.

The rendering starts from the simulated walk itself, so log, reader, estimator `truth`, wire, page and shaders are all in between.
"""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from assets.render import Renderer
from assets.site import load_site
from server.showing import Showing
from tests.web.pages import SIZE_PX, ArPage, Pixels, open_page
from tests.web.walk import CORNER_PX, ROOT, make_scene, make_walk, position_of

pytestmark = pytest.mark.browser

MONUMENTS = ("basilica_stoa", "temple_agora", "chalcidicum_w", "south_stoa", "prytaneion")
FRAMES = (2, 25, 34)
LIMIT_PX = 1.0
"""What every corner keeps (the project promises 3)."""
USUAL_DRAWN_PX = 0.3
"""What half of the corners must keep: squares of whole pixels there, discs here."""
PROJECTED_PX = 0.3
"""Of `agora.project`, which draws nothing."""
COLOURS = ((255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (255, 0, 255), (0, 255, 255))
"""Red, green, blue."""
TARGET_REACH_PX = 8.0
"""No part of a target is further than this from its centre."""
APART_PX = 24.0
"""Targets nearer to one another than this would hide each other."""

Points = NDArray[np.float64]


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    """The test's own rendering of the same square."""
    with Renderer(make_scene(load_site(ROOT / "assets" / "state_agora")), *SIZE_PX) as renderer:
        yield renderer


@pytest.fixture(scope="module")
def ar(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The AR page, paused."""
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}ar?effort=full")
        page.until_drawn()
        page.pause()
        yield page


def footprint_corners() -> dict[str, Points]:
    """Return each monument's corners (n, 3) at the level of the paving, site frame."""
    monuments = {m.id: m for m in load_site(ROOT / "assets" / "state_agora").monuments}
    return {name: np.array([(e, n, 0.0) for e, n in monuments[name].footprint.corners_en_m]) for name in MONUMENTS}


def centroids(plain: Pixels, marked: Pixels, count: int) -> list[Points]:
    """Return the centre (x, y) of what each of the first colours covers, to parts of a pixel."""
    changed = marked.astype(float) - plain
    found = []
    for colour in np.array(COLOURS[:count], float):
        pure = (np.abs(marked - colour).max(-1) < 60.0) & (np.abs(changed).sum(-1) > 60.0)
        assert pure.sum() >= 9, f"no target of the colour {colour} is to be seen"
        y, x = np.nonzero(pure)
        # how much of a pixel the target covers: the change along the way from what was there to the target's colour
        way = colour - plain
        cover = np.clip((changed * way).sum(-1) / np.maximum((way * way).sum(-1), 1.0), 0.0, 1.0)
        rows, columns = np.indices(cover.shape)
        cover[np.hypot(columns - x.mean(), rows - y.mean()) > TARGET_REACH_PX] = 0.0
        found.append(np.array([(columns * cover).sum(), (rows * cover).sum()]) / cover.sum())
    return found


def apart(pixels: Points) -> list[int]:
    """Return which of the points (n, 2) to mark at once: within the picture, off its coloured corners, none hiding another."""
    chosen: list[int] = []
    width, height = SIZE_PX
    for i, (x, y) in enumerate(pixels):
        inside = CORNER_PX + 8 < x < width - CORNER_PX - 8 and 12 < y < height - 12
        if inside and all(np.hypot(*(pixels[j] - pixels[i])) > APART_PX for j in chosen):
            chosen.append(i)
    return chosen[: len(COLOURS)]


def mark(ar: ArPage, points: Points) -> Pixels:
    """Return what the page draws with targets at points (n, 3) of the site."""
    css = [f"rgb({r}, {g}, {b})" for r, g, b in COLOURS[: len(points)]]
    ar.ask("([points, colours]) => agora.debugTargets(points, colours)", [points.tolist(), css])
    return ar.pixels()


def render(renderer: Renderer, frame_id: int, points: Points) -> Pixels:
    """Return a rendering from the true place of a picture, with targets at points of the site."""
    walk = make_walk()
    camera = walk.rig.camera
    assert camera is not None
    pose = walk.T_site_cam(walk.frame_times()[frame_id][0])
    intrinsics = (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)
    bgr = [(b, g, r) for r, g, b in COLOURS[: len(points)]]
    picture = renderer.target_scene(points, bgr, pose, *intrinsics, camera.distortion_model, camera.distortion)
    return picture[..., ::-1]


def gaps_px(ar: ArPage, renderer: Renderer, frame_id: int) -> dict[str, Points]:
    """Return how far from the rendering's corners the page draws, and projects, those of each monument in sight, (n, 2)."""
    gaps: dict[str, Points] = {}
    nothing = np.zeros((0, 3))
    plain, plain_rendering = mark(ar, nothing), render(renderer, frame_id, nothing)
    for name, corners in footprint_corners().items():
        asked = ar.ask("(points) => points.map((point) => agora.project(point) ?? [-1, -1])", corners.tolist())
        projected = np.array(asked, float)
        chosen = apart(projected)
        if chosen:
            points, n = corners[chosen], len(chosen)
            expected = np.array(centroids(plain_rendering, render(renderer, frame_id, points), n))
            drawn = np.array(centroids(plain, mark(ar, points), n))
            both = np.stack([drawn - expected, projected[chosen] - expected], axis=1)
            gaps[name] = np.linalg.norm(both, axis=-1)
    return gaps


def test_footprint_corners_lie_where_a_rendering_has_them(ar: ArPage, renderer: Renderer) -> None:
    seen: list[dict[str, Points]] = []
    for frame_id in FRAMES:
        ar.seek(position_of(frame_id))
        ar.until(f"agora.stats().lastFrameId === {frame_id} && agora.stats().lastPoseFrameId === {frame_id}")
        seen.append(gaps_px(ar, renderer, frame_id))
    assert {name for gaps in seen for name in gaps} == set(MONUMENTS)
    assert all(seen)
    drawn, projected = np.concatenate([gap for gaps in seen for gap in gaps.values()]).T
    assert drawn.max() < LIMIT_PX
    assert np.median(drawn) < USUAL_DRAWN_PX
    assert projected.max() < PROJECTED_PX
