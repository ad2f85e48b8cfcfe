"""`tests/golden/project.json`: where OpenCV sees points through each lens model. `lens.test.ts` reads the same file.

Run as a program, this file writes it anew.
"""

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np

GOLDEN_PATH = Path(__file__).parents[1] / "golden" / "project.json"
TOLERANCE_PX = 1e-6
POINTS = 24
#: Model, coefficients, and the tangent of the widest angle off the axis at which points are taken.
LENSES: tuple[tuple[str, tuple[float, ...], float], ...] = (
    ("none", (), 2.0),
    ("plumb_bob", (-0.09, 0.02, 0.0005, -0.0004, 0.0), 0.9),
    ("plumb_bob", (0.12, -0.25, -0.001, 0.002, 0.09), 0.7),
    ("rational_polynomial", (0.31, 0.04, 0.0004, -0.0003, 0.001, 0.65, 0.12, 0.005), 1.6),
    ("equidistant", (0.0034, 0.00072, -0.0021, 0.0002), 5.0),
)


def golden() -> dict[str, Any]:
    """Return what the file must hold: per lens its numbers, points (x, y, z) of the camera's frame, and their pixels."""
    rng = np.random.default_rng(1606)
    return {
        "note": "Pixels by OpenCV (projectPoints, fisheye.projectPoints); tests/web/test_golden_project.py makes this file.",
        "lenses": [_lens(rng, *lens) for lens in LENSES],
    }


def _lens(rng: np.random.Generator, model: str, coefficients: tuple[float, ...], widest: float) -> dict[str, Any]:
    size_px = (640, 480)
    fx, fy, cx, cy = 512.5, 508.25, 321.25, 238.5
    angle = rng.uniform(0.0, 2.0 * np.pi, POINTS)
    radius = widest * np.sqrt(rng.uniform(0.0, 1.0, POINTS))
    depth_m = rng.uniform(0.5, 80.0, POINTS)
    points = np.stack([radius * np.cos(angle) * depth_m, radius * np.sin(angle) * depth_m, depth_m], axis=1).round(6)
    K = np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
    project = cv2.fisheye.projectPoints if model == "equidistant" else cv2.projectPoints
    pixels, _ = project(points[:, None], np.zeros(3), np.zeros(3), K, np.array(coefficients or (0.0,) * 4))
    return {
        "lens": {
            "width_px": size_px[0],
            "height_px": size_px[1],
            "fx_px": fx,
            "fy_px": fy,
            "cx_px": cx,
            "cy_px": cy,
            "model": model,
            "coefficients": [*coefficients, *(0.0,) * (8 - len(coefficients))],
        },
        "points_cam_m": points.tolist(),
        "pixels": np.asarray(pixels).reshape(-1, 2).round(9).tolist(),
    }


def test_the_golden_file_is_what_opencv_says() -> None:
    kept, fresh = json.loads(GOLDEN_PATH.read_text(encoding="utf-8")), golden()
    assert [entry["lens"] for entry in kept["lenses"]] == [entry["lens"] for entry in fresh["lenses"]]
    for ours, theirs in zip(kept["lenses"], fresh["lenses"], strict=True):
        np.testing.assert_array_equal(ours["points_cam_m"], theirs["points_cam_m"])
        np.testing.assert_allclose(ours["pixels"], theirs["pixels"], rtol=0.0, atol=TOLERANCE_PX)


if __name__ == "__main__":
    fresh = golden()
    lines = ",\n ".join(json.dumps(entry) for entry in fresh["lenses"])
    GOLDEN_PATH.write_text(f'{{"note": {json.dumps(fresh["note"])}, "lenses": [\n {lines}\n]}}\n', encoding="utf-8")
