"""Tests that the browser of the tests can do what the pages need."""

import pytest
from playwright.sync_api import Browser


@pytest.mark.browser
def test_the_browser_draws_webgl_2(browser: Browser) -> None:
    page = browser.new_page()
    try:
        red = page.evaluate(
            """() => {
                const gl = document.createElement("canvas").getContext("webgl2");
                gl.clearColor(1, 0, 0, 1);
                gl.clear(gl.COLOR_BUFFER_BIT);
                const pixel = new Uint8Array(4);
                gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
                return [...pixel];
            }"""
        )
    finally:
        page.close()
    assert red == [255, 0, 0, 255]
