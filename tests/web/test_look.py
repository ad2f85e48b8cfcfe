"""The model belongs to the picture, and the picture stays as it was taken; what a visitor may choose of both."""

import base64
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser

from assets.site import load_site
from server.showing import Showing
from tests.web.injecting import T_START_NS, Injecting, frame_message, turned
from tests.web.pages import ArPage, open_page
from tests.web.walk import ROOT
from tracker.rig import CameraModel

pytestmark = pytest.mark.browser

CAMERA = CameraModel(640, 480, 512.5, 508.25, 321.25, 238.5, "plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0))
EYE_M = 60.0
"""High above the square, looking level: no model in the upper half of the picture."""
SKY = slice(0, 200)

# the browser's own decoder, so that only what the page does to the pixels is seen
_DECODED = """async (jpeg) => {
    const bytes = Uint8Array.from(atob(jpeg), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes]), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height).getContext("2d");
    canvas.drawImage(bitmap, 0, 0);
    const { data } = canvas.getImageData(0, 0, bitmap.width, bitmap.height);
    let text = "";
    for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
    return btoa(text);
}"""


@pytest.fixture
def ar(browser: Browser) -> Iterator[ArPage]:
    """An empty page."""
    with open_page(browser) as page:
        yield page
        assert page.errors == []


def picture(light: float, cast: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> NDArray[np.uint8]:
    """Return a picture of all shades about a mean, in a cast of colour."""
    shades = np.random.default_rng(4).uniform(0.3, 1.7, (60, 80, 3)) * light * np.array(cast)
    return np.asarray(np.kron(np.clip(shades, 0, 255), np.ones((8, 8, 1))).astype(np.uint8))


def shown(
    ar: ArPage, showing: Showing, rgb: NDArray[np.uint8], heading_rad: float = 0.4, eye_m: float = EYE_M
) -> bytes:
    """Show one picture with the model, and return its message."""
    message = frame_message(0, T_START_NS, turned(heading_rad, eye_m), CAMERA, rgb)
    Injecting(ar.page, lambda: [message])
    ar.page.goto(f"{showing.url}ar?effort=shadows")
    ar.until_drawn()
    ar.ask("agora.setPast(1)")
    return message


def test_the_pictures_own_pixels_are_never_touched(ar: ArPage, showing: Showing) -> None:
    message = shown(ar, showing, picture(60.0, (1.2, 1.0, 0.6)))
    assert ar.ask("agora.stats().gain.some((factor) => Math.abs(factor - 1) > 0.2)")
    assert ar.stats()["triangles"] > 0
    decoded = base64.b64decode(ar.ask(_DECODED, base64.b64encode(message[384:]).decode()))
    taken = np.frombuffer(decoded, np.uint8).reshape(480, 640, 4)[..., :3]
    difference = np.abs(ar.pixels().astype(int) - taken)
    assert difference[SKY].max() <= 1
    assert difference[300:].mean() > 1  # the model is there, and only there


def test_the_model_is_as_bright_as_the_picture_and_in_its_cast(browser: Browser, showing: Showing) -> None:
    gains = {}
    for name, rgb in {
        "bright": picture(150.0),
        "dark": picture(60.0),
        "warm": picture(130.0, (1.3, 1.0, 0.6)),
    }.items():
        with open_page(browser) as ar:
            shown(ar, showing, rgb)
            gains[name] = np.array(ar.stats()["gain"])
    assert gains["dark"].mean() < 0.5 * gains["bright"].mean()
    assert np.ptp(gains["bright"]) < 0.05
    assert gains["warm"][0] > 1.2 * gains["warm"][2]


def test_the_sun_is_chosen_and_told(ar: ArPage, showing: Showing) -> None:
    shown(ar, showing, picture(120.0))
    ar.page.click("#look summary")
    assert ar.page.input_value("#sun") == "now"
    now = ar.stats()["sun"]
    ar.page.select_option("#sun", "17.5")
    evening = ar.stats()["sun"]
    assert evening["elevation_rad"] < now["elevation_rad"]
    assert "west" in ar.page.inner_text("#sun-words")
    ar.page.select_option("#sun", "ancient")
    ancient = ar.stats()["sun"]
    assert 0.0 < abs(ancient["elevation_rad"] - now["elevation_rad"]) < np.radians(0.3)


def test_past_and_present_by_keys_and_said(ar: ArPage, showing: Showing) -> None:
    shown(ar, showing, picture(120.0))
    ar.page.keyboard.press("t")
    assert ar.page.input_value("#past") == "0"
    assert ar.ask("document.querySelector('#said').textContent") == "today alone"
    ar.page.keyboard.press("t")
    ar.page.keyboard.press("[")
    assert ar.page.input_value("#past") == "75"
    assert ar.ask("document.querySelector('#said').textContent").startswith("75 percent of the square")
    ar.page.focus("#past")
    ar.page.keyboard.press("ArrowRight")
    assert ar.page.get_attribute("#past", "aria-valuetext").startswith("76 percent")  # type: ignore[union-attr]
    assert ar.ask("document.querySelector('#said').textContent") == ""


def test_the_evidence_is_seen_over_the_picture(ar: ArPage, showing: Showing) -> None:
    shown(ar, showing, picture(120.0))
    plain = ar.pixels().astype(int)
    ar.page.click("#look summary")
    ar.page.check("#evidence")
    assert ar.page.is_visible("#legend")
    tinted = ar.pixels().astype(int)
    assert np.abs(tinted - plain)[300:].mean() > 1
    ar.page.uncheck("#evidence")


def test_rival_reconstructions_are_chosen_over_the_picture(ar: ArPage, showing: Showing) -> None:
    site = load_site(ROOT / "assets" / "state_agora")
    rivals = [monument for monument in site.monuments if len(monument.variants) > 1]
    middles = [np.mean(monument.footprint.corners_en_m, axis=0) for monument in rivals]
    east, north = max(middles, key=np.linalg.norm)
    shown(ar, showing, picture(120.0), float(np.arctan2(east, north)), eye_m=25.0)
    plain = ar.pixels().astype(int)
    ar.page.click("#look summary")
    menus = ar.page.locator("#rivals select")
    assert menus.count() == len(rivals)
    for menu in menus.all():
        options = menu.evaluate("(menu) => [...menu.options].map((option) => option.value)")
        menu.select_option(next(option for option in options if option != menu.input_value()))
    assert (np.abs(ar.pixels().astype(int) - plain).max(axis=-1) > 8).mean() > 0.002
