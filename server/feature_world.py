"""The site as a feature camera sees it, and the walks there: assets and tracker joined for studies."""

from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

from assets.corners import CornerAtlas
from assets.scene import content_of
from assets.site import Site
from assets.terrain import build_terrain
from assets.today import build_today
from server.site_tour import tour_of
from server.standing import origin_of
from tracker.choreography import DATASET_DURATION_S
from tracker.simulate import Walk, WalkSettings, default_rig

FOLDER = Path("build/corners")


@contextmanager
def world_of(site: Site, folder: Path = FOLDER) -> Iterator[CornerAtlas]:
    """Give the site of today as a world for `FeatureCamera`, to one thread.

    Squares of ground that nobody has stood on are drawn and kept in `folder`, which processes may share.
    """
    scene, content = build_today(site, lambda _: None), sha256()
    for part in content_of(scene):
        content.update(part)
    terrain = build_terrain(site)
    with CornerAtlas(lambda: scene, content.hexdigest()[:16], terrain.ground_z_m, site.eye_height_m, folder) as atlas:
        yield atlas


def dataset_walk(site: Site, dataset: int, seed: int) -> Walk:
    """Return a walk in the manner of the paper's dataset 1 to 5: the one of `agora simulate --dataset --seed`."""
    return walk_on(
        site,
        WalkSettings(
            dataset=dataset,
            seed=seed,
            duration_s=DATASET_DURATION_S[dataset],
            tour=tour_of(site),
            origin=origin_of(site),
            eye_height_m=site.eye_height_m,
        ),
    )


def walk_on(site: Site, settings: WalkSettings) -> Walk:
    """Return a walk on the site's ground."""
    return Walk(settings, default_rig(), build_terrain(site).ground_z_m)
