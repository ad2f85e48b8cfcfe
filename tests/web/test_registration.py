"""Where the page draws: footprint corners of five monuments, beside a rendering of the same corners that knows nothing of the page.

The rendering starts from the simulated walk itself, so log, reader, estimator `truth`, wire, page and shaders are all in between.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from assets.render import Renderer
from assets.site import load_site
from server.showing import Showing
from tests.web.pages import SIZE_PX, ArPage, Pixels, open_page
from tests.web.walk import CORNER_PX, ROOT, make_scene, make_walk, position_of, showing_walk
from tracker.rig import CameraModel

pytestmark = pytest.mark.browser

MONUMENTS = ("basilica_stoa", "temple_agora", "chalcidicum_w", "south_stoa", "prytaneion")
FRAMES = (2, 16, 25, 34)
LIMIT_PX = 3.0
"""What the project promises."""
USUAL_PX = 0.5
"""What half of the corners must keep: the page's targets are squares in the undistorted drawing, the rendering's are discs."""
PROJECT_PX = 0.1
"""Of `agora.project`, which draws nothing: what the truth's interpolation between its samples leaves, and the wire's float32."""
COLOURS = ((255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0), (255, 0, 255), (0, 255, 255))
"""Red, green, blue."""
APART_PX = 24.0
"""Targets nearer to one another than this would hide each other."""

Points = NDArray[np.float64]


@pytest.fixture(scope="module")
def showing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Showing]:
    """The walk on a server, played by its truth."""
    with showing_walk(tmp_path_factory.mktemp("registration")) as showing:
        yield showing


@pytest.fixture(scope="module")
def renderer() -> Iterator[Renderer]:
    """The test's own rendering of the same square."""
    with Renderer(make_scene(load_site(ROOT / "assets" / "state_agora")), *SIZE_PX) as renderer:
        yield renderer


@pytest.fixture(scope="module")
def ar(browser: Browser, showing: Showing) -> Iterator[ArPage]:
    """The AR page, paused."""
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}ar")
        page.until_drawn()
        page.pause()
        yield page


def footprint_corners() -> dict[str, Points]:
    """Return each monument's corners (n, 3) at the level of the paving, site frame."""
    monuments = {m.id: m for m in load_site(ROOT / "assets" / "state_agora").monuments}
    return {name: np.array([(e, n, 0.0) for e, n in monuments[name].footprint.corners_en_m]) for name in MONUMENTS}


def lens_of(camera: CameraModel) -> tuple[Any, ...]:
    """Return what the renderer needs of the rig's camera."""
    return (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.distortion_model, camera.distortion)


def centroids(plain: Pixels, marked: Pixels, count: int) -> list[Points | None]:
    """Return the centre (x, y) of what each of the first colours covers; None where it covers less than 12 pixels."""
    changed = marked.astype(float) - plain
    nearest = np.argmin([np.abs(marked - np.array(c, float)).sum(-1) for c in COLOURS], axis=0)
    found: list[Points | None] = []
    for i in range(count):
        whole = np.array(COLOURS[i], float) - plain
        # how much of the pixel the target covers, by the change along the way to its colour
        cover = np.clip((changed * whole).sum(-1) / np.maximum((whole * whole).sum(-1), 1.0), 0.0, 1.0)
        cover[(nearest != i) | (np.abs(changed).sum(-1) < 60.0)] = 0.0
        y, x = np.nonzero(cover)
        weights = cover[y, x]
        seen = weights.sum() >= 12.0
        found.append(np.array([x @ weights, y @ weights]) / weights.sum() if seen else None)
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


def page_centroids(ar: ArPage, points: Points) -> list[Points | None]:
    """Return where the page draws targets at points of the site."""
    ar.ask("agora.debugTargets([], [])")
    plain = ar.pixels()
    css = [f"rgb({r}, {g}, {b})" for r, g, b in COLOURS[: len(points)]]
    ar.ask("([points, colours]) => agora.debugTargets(points, colours)", [points.tolist(), css])
    return centroids(plain, ar.pixels(), len(points))


def rendered_centroids(renderer: Renderer, frame_id: int, points: Points) -> list[Points | None]:
    """Return where a rendering from the true place of a picture has targets at the same points."""
    walk = make_walk()
    assert walk.rig.camera is not None
    pose = walk.T_site_cam(walk.frame_times()[frame_id][0])
    lens = lens_of(walk.rig.camera)
    bgr = [(b, g, r) for r, g, b in COLOURS[: len(points)]]
    plain = renderer.render(pose, *lens)[..., ::-1]
    return centroids(plain, renderer.target_scene(points, bgr, pose, *lens)[..., ::-1], len(points))


def test_footprint_corners_lie_where_a_rendering_has_them(ar: ArPage, renderer: Renderer) -> None:
    drawn_px: list[float] = []
    projected_px: list[float] = []
    measured: set[str] = set()
    for frame_id in FRAMES:
        ar.seek(position_of(frame_id))
        ar.until(f"agora.stats().lastFrameId === {frame_id} && agora.stats().lastPoseFrameId === {frame_id}")
        for name, corners in footprint_corners().items():
            pixels = ar.ask("(points) => points.map((p) => agora.project(p) ?? [-1, -1])", corners.tolist())
            chosen = apart(np.array(pixels, float))
            if not chosen:
                continue
            expected = rendered_centroids(renderer, frame_id, corners[chosen])
            drawn = page_centroids(ar, corners[chosen])
            assert all(centre is not None for centre in expected + drawn), (frame_id, name)
            measured.add(name)
            drawn_px += [float(np.hypot(*(a - b))) for a, b in zip(drawn, expected, strict=True)]  # type: ignore[operator]
            projected_px += [float(np.hypot(*(np.array(pixels[i]) - b))) for i, b in zip(chosen, expected, strict=True)]
    print(np.round(drawn_px, 2), np.round(projected_px, 2), measured)
    assert measured == set(MONUMENTS)
    assert max(drawn_px) < LIMIT_PX
    assert max(projected_px) < LIMIT_PX
    assert np.median(drawn_px) < USUAL_PX
    assert np.median(projected_px) < USUAL_PX
