"""Where the study's walks are: the State Agora of today under hills, and a camera that sees its corners lifted with them."""

from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cache

from assets.corners import CornerAtlas
from assets.corners import Corners as SiteCorners
from assets.site import load_site
from assets.terrain import build_terrain
from server.feature_world import world_of
from server.motions import feature_motions
from server.paper.cases import SITE
from server.site_tour import tour_of
from server.standing import origin_of
from tests.benchmarks.accuracy.terrain import hills_m
from tests.benchmarks.accuracy.visitor import Visitor
from tests.benchmarks.accuracy.world import Place
from tracker.measurements import Matrix, VisualMotion


@dataclass(frozen=True)
class Lifted:
    """The corners of a site that stands on hills: every one is raised by the hill below it."""

    atlas: CornerAtlas

    @property
    def key(self) -> str:
        """What tells it from others: motions are kept by the walk's poses too, which know the hills."""
        return f"{self.atlas.key}-hills"

    def corners(self, p_site_m: Matrix) -> SiteCorners:
        """Return what a camera at (3,) may see."""
        found = self.atlas.corners(p_site_m)
        p = found.p_site_m.copy()
        p[:, 2] += hills_m(p[:, 0], p[:, 1])
        return replace(found, p_site_m=p)


@cache
def agora() -> Place:
    """Return the State Agora, opened once for each process."""
    site = load_site(SITE)
    return Place(tour_of(site), origin_of(site), build_terrain(site).ground_z_m, _motions)


_OPEN = ExitStack()


@cache
def _world() -> Lifted:
    return Lifted(_OPEN.enter_context(world_of(load_site(SITE))))


def _motions(walk: Visitor) -> list[VisualMotion]:
    return feature_motions(walk, _world())


def close() -> None:
    """Close what was opened in this process."""
    _OPEN.close()
    _world.cache_clear()
