"""That the watch over the pages sees what it is there for."""

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.confinement import Confinement
from tests.web.pages import open_page

pytestmark = pytest.mark.browser


def test_a_request_to_a_stranger_is_refused_by_the_policy_and_both_are_noticed(
    browser: Browser, showing: Showing, confinement: Confinement
) -> None:
    with open_page(browser) as page:
        page.page.goto(f"{showing.url}ar")
        assert confinement.breaches == []
        page.ask("fetch('http://127.0.0.1:9/stranger').catch(() => null)")
        page.until("true")
    assert any("Content Security Policy" in breach for breach in confinement.breaches)
    confinement.breaches.clear()


def test_a_page_that_asks_another_server_is_noticed(browser: Browser, confinement: Confinement) -> None:
    with open_page(browser) as page:
        page.page.route("**/*", lambda route: route.fulfill(content_type="text/html", body="<p>of somebody else's</p>"))
        page.page.goto("http://127.0.0.1:9/")
        assert confinement.breaches == []
        page.ask("fetch('http://127.0.0.1:10/', { mode: 'no-cors' }).catch(() => null)")
    assert confinement.breaches == ["http://127.0.0.1:9/ asked for http://127.0.0.1:10/"]
    confinement.breaches.clear()
