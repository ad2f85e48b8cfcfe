"""A brought model as a node of a scene, beside the monuments that are built."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.brought import pieces
from assets.errors import SiteError
from assets.facts import monument_facts
from assets.materials import MATERIALS
from assets.scene import Node
from assets.shape import Mesh
from assets.site import Monument

MATERIAL = "plaster"
"""The most even one there is; the model's own colours tint it."""


def brought_node(monument: Monument) -> Node:
    """Return a monument of the kind `model`, the same at every level of detail and in every epoch.

    Raises:
        SiteError: Its file has gone or broken since the site was read.
    """
    if monument.model is None:
        raise SiteError(f"monument '{monument.id}' is of kind '{monument.kind}', which brings no file.")
    meshes = [
        Mesh(
            MATERIAL,
            piece.positions_m.astype(np.float32),
            piece.normals.astype(np.float32),
            _laid(piece.positions_m),
            piece.colours,
            piece.triangles.astype(np.uint32),
        )
        for piece in pieces(monument.model, f"{monument.id}.model.file", Path("monuments.toml"))
    ]
    return Node(monument.id, meshes, monument_facts(monument) | {"role": "building", "monument": monument.id})


def _laid(positions_m: Array) -> NDArray[np.float32]:
    """Texture coordinates that stretch on no side: along x and y together, and up."""
    along, up = positions_m[:, 0] + positions_m[:, 1], positions_m[:, 2] + positions_m[:, 0] - positions_m[:, 1]
    return (np.stack([along, up], -1) / MATERIALS[MATERIAL].tile_m).astype(np.float32)
