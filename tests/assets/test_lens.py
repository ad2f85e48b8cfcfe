"""Distortion: every pixel's ray projects back to that pixel by OpenCV, and the wide picture holds it."""

import cv2
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from assets.lens import Lens, Pinhole

PINHOLE = Pinhole(64, 48, 52.0, 51.0, 32.3, 23.1)
K = np.array([[52.0, 0.0, 32.3], [0.0, 51.0, 23.1], [0.0, 0.0, 1.0]])
MILD = st.floats(-0.08, 0.08)
SLIGHT = st.floats(-0.003, 0.003)


def pixels() -> NDArray[np.float64]:
    return np.stack(np.meshgrid(np.arange(64.0), np.arange(48.0)), axis=-1).reshape(-1, 2)


def covers_the_picture(k: tuple[float, ...]) -> bool:
    """Return whether the polynomial grows up to the picture's corners: one that folds before has no ray for them."""
    k1, k2, _, _, k3, k4, k5, k6 = (*k, 0.0, 0.0, 0.0)[:8]
    r2 = np.linspace(0.0, 1.5, 301) ** 2
    bent = np.sqrt(r2) * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    folds = np.nonzero(np.diff(bent) <= 0.0)[0]
    corner = float(np.hypot(*((pixels() - (32.3, 23.1)) / (52.0, 51.0)).T).max())
    return float(bent[folds[0]] if len(folds) else bent[-1]) > corner + 0.05


def projected(lens: Lens) -> NDArray[np.float64]:
    rays = lens.rays().reshape(-1, 2)
    points = np.column_stack([rays, np.ones(len(rays))]).reshape(-1, 1, 3)
    coefficients = np.array(lens.distortion)
    zero = np.zeros(3)
    if lens.distortion_model == "equidistant":
        flat = cv2.fisheye.projectPoints(points, zero, zero, K, coefficients)[0]
    else:
        flat = cv2.projectPoints(points, zero, zero, K, coefficients)[0]
    return np.asarray(flat, dtype=np.float64).reshape(-1, 2)


@settings(max_examples=40, deadline=None)
@given(k1=MILD, k2=MILD, p1=SLIGHT, p2=SLIGHT, k3=MILD)
def test_plumb_bob_is_opencvs(k1: float, k2: float, p1: float, p2: float, k3: float) -> None:
    lens = Lens(PINHOLE, "plumb_bob", (k1, k2, p1, p2, k3))
    assume(covers_the_picture(lens.distortion))
    assert projected(lens) == pytest.approx(pixels(), abs=0.01)


@settings(max_examples=40, deadline=None)
@given(k=st.tuples(MILD, MILD, SLIGHT, SLIGHT, MILD, MILD, MILD, MILD))
def test_rational_polynomial_is_opencvs(k: tuple[float, ...]) -> None:
    assume(covers_the_picture(k))
    assert projected(Lens(PINHOLE, "rational_polynomial", k)) == pytest.approx(pixels(), abs=0.01)


@settings(max_examples=40, deadline=None)
@given(k=st.tuples(st.floats(-0.05, 0.05), SLIGHT, SLIGHT, SLIGHT))
def test_equidistant_is_opencvs(k: tuple[float, ...]) -> None:
    assert projected(Lens(PINHOLE, "equidistant", k)) == pytest.approx(pixels(), abs=0.01)


@pytest.mark.parametrize(
    ("model", "distortion"),
    [("plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0)), ("equidistant", (0.02, 0.0, 0.0, 0.0))],
)
def test_the_wide_picture_holds_every_ray_where_it_says(model: str, distortion: tuple[float, ...]) -> None:
    lens = Lens(PINHOLE, model, distortion)
    wide, place = lens.oversized()
    rays = (place - (wide.cx_px, wide.cy_px)) / (wide.fx_px, wide.fy_px)
    assert rays == pytest.approx(lens.rays(), abs=1e-5)
    assert place.min() >= 1.0
    assert (place.reshape(-1, 2).max(axis=0) <= (wide.width_px - 2, wide.height_px - 2)).all()


@pytest.mark.parametrize(
    ("model", "distortion", "straight"),
    [
        ("none", (), True),
        ("plumb_bob", (0.0, 0.0), True),
        ("plumb_bob", (0.1,), False),
        ("equidistant", (0.0,), False),
    ],
)
def test_only_what_bends_is_remapped(model: str, distortion: tuple[float, ...], straight: bool) -> None:
    assert Lens(PINHOLE, model, distortion).is_straight is straight


def test_an_unknown_model_is_named() -> None:
    with pytest.raises(ValueError, match="distortion_model is 'kannala'"):
        Lens(PINHOLE, "kannala", (0.1,)).rays()
