"""The overlay's three styles as pixels, and what is left clear: the same picture with one doubt after another."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from playwright.sync_api import Browser, WebSocketRoute

from server.showing import Showing
from tests.web.pages import ArPage, Pixels, open_page
from tests.web.tampering import Doubting
from tests.web.walk import position_of

pytestmark = pytest.mark.browser

FRAME = 25
OUTLINE = np.array([250, 230, 184])
"""Red, green, blue."""


class Styled:
    """The page at one picture."""

    def __init__(self, ar: ArPage, doubting: Doubting) -> None:
        self.ar, self._doubting = ar, doubting

    def pixels(self, sigma_m: float, sigma_deg: float, speed_m_s: float = 0.0) -> Pixels:
        """Return the composite with a doubt: one sigma of place and heading."""
        doubting = self._doubting
        doubting.sigma_m, doubting.sigma_deg = sigma_m, sigma_deg
        doubting.v_m_s = (speed_m_s, 0.0, 0.0)
        self.ar.seek(position_of(FRAME - 3))
        self.ar.until(f"agora.stats().lastFrameId === {FRAME - 3}")
        self.ar.seek(position_of(FRAME))
        self.ar.until(f"agora.stats().lastFrameId === {FRAME}")
        return self.ar.pixels()

    @property
    def style(self) -> str:
        """What the page says that it draws."""
        return str(self.ar.stats()["overlay"])

    def plain(self) -> Pixels:
        """Return the picture without the model."""
        self.ar.ask("agora.setPast(0)")
        pixels = self.ar.pixels()
        self.ar.ask("agora.setPast(1)")
        return pixels


@pytest.fixture(scope="module")
def styled(browser: Browser, showing: Showing) -> Iterator[Styled]:
    """The page, paused, all of the past shown."""
    with open_page(browser) as ar:
        doubting = Doubting(ar.page)
        ar.page.goto(f"{showing.url}ar")
        ar.until_drawn()
        ar.pause()
        ar.ask("agora.setPast(1)")
        yield Styled(ar, doubting)


def changed(pixels: Pixels, plain: Pixels) -> NDArray[np.int64]:
    """Return (height, width) by how much each pixel differs from the picture alone."""
    return np.asarray(np.abs(pixels.astype(np.int64) - plain).max(axis=2))


def outlined(pixels: Pixels) -> NDArray[np.bool_]:
    """Return (height, width) which pixels have about the colour of outlines."""
    return np.asarray(np.abs(pixels.astype(np.int64) - OUTLINE).max(axis=2) < 40)


def test_what_is_sure_covers_what_is_less_sure_shines_through_and_what_is_unsure_is_not_drawn(styled: Styled) -> None:
    locked = styled.pixels(0.5, 0.5)
    assert styled.style == "locked"
    plain = styled.plain()
    covered = changed(locked, plain) > 40
    assert covered.mean() > 0.05, "else there is nothing to compare"

    ghost = styled.pixels(3.0, 3.0)
    assert styled.style == "ghost"
    assert outlined(ghost).sum() > 10 * max(1, outlined(locked).sum())
    inside = covered & ~outlined(ghost)
    through = changed(ghost, plain)[inside] / changed(locked, plain)[inside]
    assert 0.25 < np.median(through) < 0.6

    guided = styled.pixels(3.0, 20.0)
    assert styled.style == "guide"
    assert (guided == plain).all()
    assert styled.ar.page.is_visible("#wayfinder")
    assert styled.ar.page.inner_text("#way-words").startswith("The middle of the square is ")
    assert "where the visitor looks" in styled.ar.page.inner_text("#advice")
    styled.pixels(0.5, 0.5)
    assert not styled.ar.page.is_visible("#wayfinder")
    assert not styled.ar.page.is_visible("#advice")


def test_while_walking_the_ground_ahead_is_the_pictures(styled: Styled) -> None:
    """And what is further away, or higher, is drawn as before."""
    standing = styled.pixels(0.5, 0.5)
    plain = styled.plain()
    walking = styled.pixels(0.5, 0.5, speed_m_s=1.2)
    assert styled.style == "locked"
    near = np.s_[440:, :]
    assert changed(standing, plain)[near].max() > 3, "the model's paving"
    assert changed(walking, plain)[near].max() <= 1
    far = np.s_[:200, :]
    # but for how bright the model is drawn, which follows the picture slowly
    assert (changed(walking, standing)[far] < 12).mean() > 0.98
    assert (changed(standing, plain)[far] > 40).mean() > 0.05
    assert styled.ar.errors == []


def _as_live(route: WebSocketRoute) -> None:
    server = route.connect_to_server()

    def passed(message: str | bytes) -> None:
        is_text = isinstance(message, str)
        route.send(message.replace('"kind":"replay"', '"kind":"live"') if is_text else message)  # type: ignore[arg-type]

    server.on_message(passed)


def test_who_walks_is_asked_to_take_care_once(browser: Browser, showing: Showing) -> None:
    """And who watches a recording is not (every other test's page would be covered)."""
    with open_page(browser) as ar:
        ar.page.route_web_socket("**/ws/view/**", _as_live)
        ar.page.goto(f"{showing.url}ar")
        ar.until("globalThis.agora?.session?.()?.kind === 'live'")
        ar.until("!document.querySelector('#care').hidden")
        assert "Look at the ground" in ar.page.inner_text("#care")
        ar.page.click("#careful")
        assert not ar.page.is_visible("#care")
        ar.page.reload()
        ar.until("globalThis.agora?.session?.()?.kind === 'live'")
        ar.page.wait_for_timeout(200)
        assert not ar.page.is_visible("#care")
        assert ar.errors == []
