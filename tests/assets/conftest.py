"""Fixtures of the assets' tests: the site, its models, and off-screen OpenGL."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from assets.gltf import Scene
from assets.render import Renderer
from assets.roman import build_roman
from assets.site import Site, load_site
from assets.terrain import Terrain, build_terrain
from assets.today import build_today
from tests.ci.machine import has_open_gl

SITE = Path(__file__).parents[2] / "assets/state_agora"


@pytest.fixture(scope="session")
def site() -> Site:
    return load_site(SITE)


@pytest.fixture(scope="session")
def terrain(site: Site) -> Terrain:
    return build_terrain(site)


@pytest.fixture(scope="session")
def roman(site: Site) -> Scene:
    return build_roman(site, lambda share: None)


@pytest.fixture(scope="session")
def today(site: Site) -> Scene:
    return build_today(site, lambda share: None)


@pytest.fixture(scope="session")
def open_gl() -> None:
    """Off-screen OpenGL; `make test` has seen to it that there is one, where it could."""
    if has_open_gl():
        return
    if os.geteuid() != 0:
        pytest.skip("not root")
    pytest.fail("no off-screen OpenGL: make test installs it, or run: apt-get install libegl1 libgl1 libgl1-mesa-dri")


@pytest.fixture
def renderer(open_gl: None) -> Iterator[Callable[[Scene, int, int], Renderer]]:
    """Makes renderers and gives their graphics memory back."""
    made: list[Renderer] = []

    def make(scene: Scene, width: int, height: int) -> Renderer:
        made.append(Renderer(scene, width, height))
        return made[-1]

    yield make
    for one in made:
        one.close()
