"""What most tests of the pages share: the walk of our own making on a server."""

from collections.abc import Iterator

import pytest

from server.showing import Showing
from tests.web.walk import showing_walk


@pytest.fixture(scope="module")
def showing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Showing]:
    """The walk on a server, played by its truth again and again, with a square of plain volumes."""
    with showing_walk(tmp_path_factory.mktemp("showing")) as showing:
        yield showing
