"""Fixtures that any test may ask for, and the rule on skips."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from playwright.sync_api import Browser, sync_playwright

from tests.ci.machine import find_browser, is_root

# The same examples at every run, so that a failure is the change's; HYPOTHESIS_PROFILE=explore looks for new ones.
settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))

pytest_plugins = ("pytester", "tests.ci.skips")

ROOT = Path(__file__).parents[1]
BROWSER_FLAGS = (
    "--no-sandbox",  # root in a container has no user namespaces
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)
"""WebGL 2 in software, the same on every machine, and no traffic of the browser's own."""


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the files that need the browser last: while Playwright is open, its event loop runs here and `asyncio.run` is refused.

    Of those, files with slow tests go first, so that in the end no process works on a long one alone.
    """
    driving = {item.path for item in items if "browser" in getattr(item, "fixturenames", ())}
    quick = driving - {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: (item.path in driving, item.path in quick))


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A Chromium with WebGL 2 in software; `make test` has seen to it that there is one, where it could."""
    executable = find_browser()
    if executable is None and not is_root():
        pytest.skip("not root")
    if executable is None:
        pytest.fail("no browser: make test installs one, or run: apt-get install chromium")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=executable, args=list(BROWSER_FLAGS))
        yield chromium
        chromium.close()


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder of recordings and notes beside a checkout, where there is one."""
    folder = ROOT.parent / "shared"
    if not folder.is_dir():
        pytest.skip("../shared absent")
    return folder
