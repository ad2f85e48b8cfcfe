"""The site as it stands today, for the simulated camera."""

from collections.abc import Callable

import numpy as np

from assets.gltf import Node, Scene
from assets.ground import terrain_meshes
from assets.materials import MATERIALS
from assets.site import Site
from assets.terrain import build_terrain


def build_today(site: Site, progress: Callable[[float], None]) -> Scene:
    """Return the site as it stands today."""
    terrain = build_terrain(site)
    nodes = [
        Node(
            "ground",
            terrain_meshes(terrain, lambda p: np.full(len(p), "grass"), lambda p: np.ones((len(p), 3))),
            {"role": "ground"},
        )
    ]
    progress(1.0)
    return Scene(nodes, {"grass": MATERIALS["grass"].paint()})
