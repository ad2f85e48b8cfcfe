"""Baked light: dark where walls meet the ground and under roofs, untouched in the open."""

import numpy as np
import pytest

from assets.ambient import DARKEST, Light
from assets.shape import Place, Shape
from assets.site import Site
from assets.terrain import Terrain

HIGH = Place.at(0.0, 0.0, 60.0)


def test_an_open_plane_keeps_its_light(terrain: Terrain) -> None:
    shape = Shape(split_m=2.0)
    shape.polygons("marble", [(0.0, 0.0, 0.0), (20.0, 0.0, 0.0), (20.0, 20.0, 0.0), (0.0, 20.0, 0.0)])
    mesh = shape.meshes(HIGH)[0]
    shaded = Light([mesh], terrain).shaded(mesh)
    assert (shaded.colours >= 250).all()


def test_a_floor_under_a_roof_is_dark(terrain: Terrain) -> None:
    shape = Shape(split_m=2.0)
    for z, turn in ((0.0, 1), (2.0, -1)):
        square = [(0.0, 0.0, z), (20.0, 0.0, z), (20.0, 20.0, z), (0.0, 20.0, z)]
        shape.polygons("marble", square[::turn])
    mesh = shape.meshes(HIGH)[0]
    light = Light([mesh], terrain)
    up = np.array([[0.0, 0.0, 1.0]])
    under, over = (light.taken(np.array([[10.0, 10.0, 60.0 + z]]), up)[0] for z in (0.0, 2.0))
    assert under > 0.4
    assert over == pytest.approx(0.0)
    assert light.shaded(mesh).colours.min() >= 255 * DARKEST - 1.0


def test_a_corner_is_darker_than_the_wall_above_it(terrain: Terrain) -> None:
    shape = Shape(split_m=2.0)
    shape.box("marble", (0.0, 0.0, -1.0), (20.0, 20.0, 0.0))
    shape.box("marble", (0.0, 18.0, 0.0), (20.0, 20.0, 8.0))
    light = Light(shape.meshes(HIGH), terrain)
    south = np.array([[0.0, -1.0, 0.0]])
    foot, top = (light.taken(np.array([[10.0, 18.0, 60.0 + z]]), south)[0] for z in (0.1, 6.0))
    assert foot > top + 0.05


def test_the_ground_takes_light_too(site: Site, terrain: Terrain) -> None:
    shape = Shape()
    shape.box("marble", (0.0, 0.0, 0.0), (1.0, 1.0, 4.0))
    light = Light(shape.meshes(Place.at(0.0, -20.0, 0.0)), terrain)
    down, up = (light.taken(np.array([[1.0, -19.5, z]]), np.array([[1.0, 0.0, 0.0]]))[0] for z in (0.1, 3.5))
    assert down > up
