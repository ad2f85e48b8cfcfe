"""What things are made of: a texture with its size on the ground, and how rough it is."""

from collections.abc import Callable
from dataclasses import dataclass

from assets import textures
from assets.textures import Texture


@dataclass(frozen=True)
class Material:
    """One surface, as glTF sees it."""

    paint: Callable[[], Texture]
    tile_m: float
    """Side of the ground that one repeat of the texture covers."""
    roughness: float


MATERIALS = {
    "marble": Material(textures.marble, 4.0, 0.7),
    "ashlar": Material(textures.ashlar, 4.0, 0.9),
    "rustic": Material(textures.rustic, 4.0, 0.95),
    "plaster": Material(textures.plaster, 6.0, 0.9),
    "paving": Material(textures.paving, 6.0, 0.85),
    "tiles": Material(textures.tiles, 3.0, 0.9),
    "grass": Material(textures.grass, 7.0, 1.0),
    "earth": Material(textures.earth, 6.0, 1.0),
    "stone": Material(textures.stone, 2.5, 0.95),
    "scrub": Material(textures.scrub, 160.0, 1.0),
    "leaves": Material(textures.leaves, 3.0, 1.0),
    "straw": Material(textures.straw, 2.0, 1.0),
    "wood": Material(textures.wood, 2.0, 0.9),
    "water": Material(textures.water, 5.0, 0.2),
}
