"""Statues: as tall as asked, broader than deep, on bases that hold them."""

import numpy as np
import pytest

from assets import statues
from tests.assets.geometry import ORIGIN, drawn


@pytest.mark.parametrize("level", [0, 1, 2])
def test_a_figure_is_as_tall_as_asked_and_broader_than_deep(level: int) -> None:
    points = drawn(statues.standing(1.9, "bronze", level)).reshape(-1, 3)
    assert (points[:, 2].min(), points[:, 2].max()) == (pytest.approx(0.0), pytest.approx(1.9))
    broad, deep = np.ptp(points[:, 0]), np.ptp(points[:, 1])
    assert 0.2 * 1.9 < broad < 0.4 * 1.9
    assert deep < broad


def test_a_figure_on_a_pedestal_is_of_its_own_material() -> None:
    meshes = {mesh.material: mesh for mesh in statues.on_pedestal(1.6, "bronze", 0).meshes(ORIGIN)}
    assert set(meshes) == {"marble", "bronze"}
    assert meshes["bronze"].positions_m[:, 2].min() == pytest.approx(meshes["marble"].positions_m[:, 2].max())


def test_a_seated_figure_looks_to_the_front() -> None:
    points = drawn(statues.seated(2.8)).reshape(-1, 3)
    assert points[:, 2].max() == pytest.approx(2.8)
    assert -points[:, 1].min() == pytest.approx(0.3 * 2.8)
