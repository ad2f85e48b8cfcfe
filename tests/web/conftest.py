"""What most tests of the pages share: the walk of our own making on a server, and a browser whose pages are watched."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from server.showing import Showing
from tests.web.confinement import Confinement
from tests.web.walk import showing_walk


@pytest.fixture(scope="module")
def showing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Showing]:
    """The walk on a server, played by its truth again and again, with a square of plain volumes."""
    with showing_walk(tmp_path_factory.mktemp("showing")) as showing:
        yield showing


@pytest.fixture(scope="session")
def confinement() -> Confinement:
    """What the pages of all tests did that they must not."""
    return Confinement()


@pytest.fixture(scope="session")
def browser(browser: Browser, confinement: Confinement) -> Iterator[Browser]:
    """The browser, watched."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(browser, "new_context", confinement.over(browser))
        yield browser


@pytest.fixture(autouse=True)
def _confined(confinement: Confinement) -> Iterator[None]:
    """Fail whichever test a page asked a stranger in, or broke its policy."""
    yield
    breaches = list(confinement.breaches)
    confinement.breaches.clear()
    assert breaches == []
