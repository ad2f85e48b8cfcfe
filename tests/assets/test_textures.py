"""Textures: tileable, the same at every run, and rich enough to be tracked."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assets.materials import MATERIALS
from assets.textures import noise


@pytest.mark.parametrize("name", MATERIALS)
def test_a_texture_is_a_square_picture_and_always_the_same(name: str) -> None:
    paint = MATERIALS[name].paint
    texture = paint()
    side = texture.shape[0]
    assert texture.shape == (side, side, 3)
    assert side & (side - 1) == 0
    assert texture.dtype == np.uint8
    assert (paint() == texture).all()


@pytest.mark.parametrize("name", ["marble", "grass", "earth", "stone", "scrub", "leaves", "plaster", "water", "straw"])
def test_a_texture_without_joints_goes_on_over_its_edge(name: str) -> None:
    rows = MATERIALS[name].paint().astype(float)
    inside = np.abs(np.diff(rows, axis=0)).mean()
    assert np.abs(rows[0] - rows[-1]).mean() < 1.5 * inside
    assert np.abs(rows[:, 0] - rows[:, -1]).mean() < 1.5 * inside


@pytest.mark.parametrize("name", ["grass", "earth", "stone", "rustic"])
def test_what_a_camera_sees_of_the_ruins_has_contrast(name: str) -> None:
    assert MATERIALS[name].paint().astype(float).std(axis=(0, 1)).min() > 8.0


@given(seed=st.integers(0, 1000), finest=st.integers(4, 30))
def test_noise_has_mean_nought_deviation_one_and_no_finer_waves(seed: int, finest: int) -> None:
    field = noise(seed, 64, 2, finest)
    assert abs(field.mean()) < 1e-9
    assert field.std() == pytest.approx(1.0)
    spectrum = np.abs(np.fft.rfft2(field))
    wave = np.hypot(np.fft.fftfreq(64)[:, None] * 64, np.fft.rfftfreq(64)[None] * 64)
    assert spectrum[wave > finest].max(initial=0.0) < 1e-6 * spectrum.max()
