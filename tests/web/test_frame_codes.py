"""Picture and pose belong together while the rig turns fast, by what the pixels say; and any camera matrix is matched."""

from base64 import b64decode
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.injecting import T_START_NS, Injecting, frame_message, turned
from tests.web.pages import SIZE_PX, open_page
from tests.web.test_registration import centroids
from tracker.rig import CameraModel

pytestmark = pytest.mark.browser

TURN_RAD_S = np.radians(100.0)
RATE_HZ = 15.0
BITS, CELL_PX = 12, 20
"""The number of a picture stands in its top rows, black and white."""
DRAWN_FRAMES = 15
NEAR_PX = 2.0
DISTORTED = CameraModel(640, 480, 512.5, 508.25, 321.25, 238.5, "plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0))
OFF_CENTRE = CameraModel(640, 480, 430.0, 560.0, 255.3, 291.7, "plumb_bob", ())
MATCHED_PX = 0.1
DIRECTIONS_RAD = np.radians(np.cumsum(np.random.default_rng(8).uniform(9.0, 25.0, 21)))
"""Of posts about the visitor: no two turns show the same pattern of them."""
POST_M, EYE_M = 30.0, 60.0
"""High above the square: nothing of it hides the number."""

# what every picture shows of itself and of the posts, read when it has just been drawn
_WATCH = """(count) => new Promise((resolve) => {
    const seen = [];
    let drawn = agora.stats().framesDrawn;
    // in pieces: a call takes no more arguments; as text: of so many numbers, each would be packed by itself
    const packed = (bytes) => {
        let text = "";
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return btoa(text);
    };
    const look = () => {
        const stats = agora.stats();
        if (stats.framesDrawn !== drawn) {
            drawn = stats.framesDrawn;
            const [code, posts] = [agora.readPixels(0, 10, 640, 1), agora.readPixels(0, 200, 640, 80)];
            seen.push({ code: packed(code), posts: packed(posts), id: stats.lastFrameId });
        }
        if (seen.length >= count) resolve(seen);
        else requestAnimationFrame(look);
    };
    look();
})"""


def coded(number: int) -> NDArray[np.uint8]:
    """Return a grey picture with its number in the top rows."""
    picture = np.full((480, 640, 3), 110, np.uint8)
    for bit in range(BITS):
        picture[:CELL_PX, bit * CELL_PX : (bit + 1) * CELL_PX] = 255 if number >> bit & 1 else 0
    return picture


def pixels_of(packed: str, rows: int) -> NDArray[np.uint8]:
    """Return rows of 640 pixels, (rows, 640, 4)."""
    return np.frombuffer(b64decode(packed), np.uint8).reshape(rows, 640, 4)


def number_in(row: NDArray[np.uint8]) -> int:
    """Return the number that a row (640, 4) of pixels tells."""
    return sum(int(row[bit * CELL_PX + CELL_PX // 2, 0] > 127) << bit for bit in range(BITS))


def heading_of(number: int) -> float:
    """Return where the rig looked when it took that picture."""
    return float(number * TURN_RAD_S / RATE_HZ)


def posts_site() -> NDArray[np.float64]:
    """Return points (n, 3) at eye level about the visitor."""
    return np.column_stack(
        [POST_M * np.sin(DIRECTIONS_RAD), POST_M * np.cos(DIRECTIONS_RAD), np.full(len(DIRECTIONS_RAD), EYE_M)]
    )


def seen_by(camera: CameraModel, points: NDArray[np.float64], T_site_cam: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the pixels (m, 2) of the points before the camera and well within the picture, by OpenCV."""
    T_cam_site = np.linalg.inv(T_site_cam)
    cam = points @ T_cam_site[:3, :3].T + T_cam_site[:3, 3]
    cam = cam[cam[:, 2] > np.abs(cam[:, 0])]
    K = np.array([[camera.fx_px, 0.0, camera.cx_px], [0.0, camera.fy_px, camera.cy_px], [0.0, 0.0, 1.0]])
    pixels, _ = cv2.projectPoints(cam, np.zeros(3), np.zeros(3), K, np.array(camera.distortion or (0.0,) * 4))
    pixels = pixels.reshape(-1, 2)
    return np.asarray(pixels[(np.abs(pixels - np.array(SIZE_PX) / 2) < np.array(SIZE_PX) / 2 - 12).all(axis=1)])


def columns_of_posts(strip: NDArray[np.uint8]) -> NDArray[np.float64]:
    """Return where magenta stands in a strip (80, 640, 4): the middle of each patch."""
    mask = (strip[..., 0] > 170) & (strip[..., 1] < 110) & (strip[..., 2] > 170)
    count, _, _, middles = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    return np.sort(middles[1:count, 0])


@pytest.mark.parametrize("effort", ["first+paint", "soft+edges"])
def test_every_picture_is_drawn_by_its_own_pose_at_100_degrees_a_second(
    browser: Browser, showing: Showing, effort: str
) -> None:
    sent = iter(range(1 << BITS))

    def some() -> list[bytes]:
        return [
            frame_message(k, T_START_NS + round(k * 1e9 / RATE_HZ), turned(heading_of(k), EYE_M), DISTORTED, coded(k))
            for k in (next(sent), next(sent), next(sent))
        ]

    with open_page(browser) as ar:
        Injecting(ar.page, some)
        ar.page.goto(f"{showing.url}ar?effort={effort}")
        ar.until_drawn()
        points = posts_site()
        ar.ask("(points) => agora.debugTargets(points, points.map(() => '#ff00ff'))", points.tolist())
        seen: list[dict[str, Any]] = ar.ask(_WATCH, DRAWN_FRAMES)
    numbers, posts = [], 0
    for shown in seen:
        number = number_in(pixels_of(shown["code"], 1)[0])
        expected = np.sort(seen_by(DISTORTED, points, turned(heading_of(number), EYE_M))[:, 0])
        found = columns_of_posts(pixels_of(shown["posts"], 80))
        inner = found[(found > 16) & (found < SIZE_PX[0] - 17)]
        assert shown["id"] == number
        assert all(np.abs(found - post).min() < NEAR_PX for post in expected), (number, expected, found)
        assert all(np.abs(expected - post).min() < NEAR_PX for post in inner), (number, expected, found)
        numbers.append(number)
        posts += len(expected)
    assert len(set(numbers)) == DRAWN_FRAMES
    assert posts > 2 * DRAWN_FRAMES


def test_an_off_centre_camera_of_two_focal_lengths_is_matched(browser: Browser, showing: Showing) -> None:
    T = turned(0.4, EYE_M)
    message = frame_message(0, T_START_NS, T, OFF_CENTRE, np.full((480, 640, 3), 150, np.uint8))
    cam = np.array([[-9.0, -6.0, 30.0], [8.0, -7.5, 31.0], [0.7, -2.0, 33.0], [15.0, 4.0, 30.0], [-12.0, 5.5, 34.0]])
    points = cam @ T[:3, :3].T + T[:3, 3]
    expected = seen_by(OFF_CENTRE, points, T)
    assert len(expected) == len(points)
    with open_page(browser, device_scale_factor=2) as ar:
        Injecting(ar.page, lambda: [message])
        ar.page.goto(f"{showing.url}ar?effort=full")
        ar.until_drawn()
        projected = np.array(ar.ask("(points) => points.map((point) => agora.project(point))", points.tolist()))
        assert np.abs(projected - expected).max() < 1e-4  # the wire has single precision
        ar.ask("agora.debugTargets([], [])")
        plain = ar.pixels()
        colours = ["#ff0000", "#00ff00", "#0000ff", "#ffff00", "#ff00ff"]
        ar.ask("([points, colours]) => agora.debugTargets(points, colours)", [points.tolist(), colours])
        drawn = np.array(centroids(plain, ar.pixels(), len(points)))
    # every target is a square of whole samples: each may lie off by half of one, all of them together do not
    assert np.abs((drawn - expected).mean(axis=0)).max() < MATCHED_PX
    assert np.linalg.norm(drawn - expected, axis=1).max() < 3 * MATCHED_PX
