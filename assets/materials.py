"""What things are made of: a texture with its size on the ground, its bumps, and how rough it is."""

from collections.abc import Callable
from dataclasses import dataclass

from assets import relief, textures
from assets.relief import Grey
from assets.textures import Texture


@dataclass(frozen=True)
class Material:
    """One surface, as glTF sees it."""

    paint: Callable[[], Texture]
    tile_m: float
    """Side of the ground that one repeat of the texture covers."""
    roughness: float
    """Of the whole; the factor of `roughness_map` is 1 where there is one."""
    normal: Callable[[], Texture] | None = None
    """glTF's normal map: x along u, y upwards in the picture, blue green red."""
    roughness_map: Callable[[], Grey] | None = None
    """(n, n), shares of 255."""


MATERIALS = {
    "marble": Material(textures.marble, 4.0, 0.6, relief.marble, relief.marble_gloss),
    "marble_grey": Material(textures.marble_grey, 4.0, 0.55, relief.marble),
    "ashlar": Material(textures.ashlar, 4.0, 0.9, relief.ashlar),
    "rustic": Material(textures.rustic, 4.0, 0.95, relief.rustic),
    "granite": Material(textures.granite, 2.0, 0.35),
    "plaster": Material(textures.plaster, 6.0, 0.9, relief.plaster),
    "painted": Material(textures.painted, 3.0, 0.8, relief.painted),
    "paving": Material(textures.paving, 8.0, 0.8, relief.paving, relief.paving_gloss),
    "tiles": Material(textures.tiles, 3.2, 0.85, relief.tiles),
    "bronze": Material(textures.bronze, 2.0, 0.4),
    "grass": Material(textures.grass, 7.0, 1.0, relief.grass),
    "earth": Material(textures.earth, 6.0, 1.0, relief.earth),
    "stone": Material(textures.stone, 2.5, 0.95, relief.stone),
    "scrub": Material(textures.scrub, 160.0, 1.0),
    "leaves": Material(textures.leaves, 3.0, 1.0),
    "straw": Material(textures.straw, 2.0, 1.0),
    "wood": Material(textures.wood, 2.0, 0.85, relief.wood),
    "water": Material(textures.water, 5.0, 0.12, relief.water),
}
