"""Normal and roughness maps: unit normals that mostly look out, no seams, the same at every run."""

import numpy as np
import pytest

from assets.materials import MATERIALS
from assets.relief import normals

BUMPY = [name for name, material in MATERIALS.items() if material.normal is not None]
GLOSSY = [name for name, material in MATERIALS.items() if material.roughness_map is not None]


@pytest.mark.parametrize("name", BUMPY)
def test_normals_have_length_one_and_look_out(name: str) -> None:
    paint = MATERIALS[name].normal
    assert paint is not None
    picture = paint()
    assert picture.shape[0] == picture.shape[1]
    assert (paint() == picture).all()
    vectors = picture[..., ::-1] / 127.5 - 1.0
    assert np.linalg.norm(vectors, axis=2) == pytest.approx(1.0, abs=0.02)
    assert vectors[..., 2].min() >= -0.01
    assert vectors[..., :2].mean(axis=(0, 1)) == pytest.approx([0.0, 0.0], abs=0.02)
    assert vectors[..., :2].std() > 0.02


@pytest.mark.parametrize("name", GLOSSY)
def test_roughness_is_one_channel_of_unequal_shares(name: str) -> None:
    paint = MATERIALS[name].roughness_map
    assert paint is not None
    picture = paint()
    assert picture.ndim == 2
    assert picture.std() > 4.0


def test_a_slope_that_rises_to_the_right_and_up_leans_left_and_down() -> None:
    size = 64
    row, column = np.mgrid[0:size, 0:size]
    wave = np.minimum(column, size - column) + np.minimum(size - row, row)
    blue, green, red = normals(wave.astype(float))[size * 3 // 4, size // 4]
    assert red < 100
    assert green < 100
    assert blue > 140
