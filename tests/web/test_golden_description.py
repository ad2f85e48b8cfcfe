"""`tests/golden/description.json`: views of the State Agora in words of geometry, by shapely. `describe.test.ts` reads it, too.

Run as a program, this file writes it anew.
"""

import json
from math import atan2, cos, degrees, hypot, inf, pi, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from shapely import LineString, Point, Polygon

from assets.facts import list_monuments
from assets.site import load_site

ROOT = Path(__file__).parents[2]
GOLDEN_PATH = ROOT / "tests" / "golden" / "description.json"
VIEWS = 24
FAR_M = 1000.0
HALF_DEG = 30
AHEAD_DEG = 10
LEAST_DEG = 0.5
FLAT_M = 0.3

Glimpse = tuple[int, float, float]
"""Degrees clockwise from the heading, metres to the nearest point, degrees of height that are seen."""


def golden() -> dict[str, Any]:
    """Return what the file must hold: the site's solids, and per view where the eye is and what it sees."""
    solids = list_monuments(load_site(ROOT / "assets" / "state_agora"))
    rng = np.random.default_rng(9)
    return {
        "note": "Views by shapely; tests/web/test_golden_description.py makes this file.",
        "half_rad": radians(HALF_DEG),
        "solids": [
            {
                "id": solid["id"],
                "footprint": solid["footprint_en"],
                "base_m": solid["base_z_m"],
                "height_m": solid["height_m"],
            }
            for solid in solids
        ],
        "views": [_view(solids, rng) for _ in range(VIEWS)],
    }


def _view(solids: list[dict[str, Any]], rng: np.random.Generator) -> dict[str, Any]:
    eye = [
        float(v) for v in (rng.uniform(-130.0, 60.0), rng.uniform(-50.0, 70.0), rng.choice([1.65, 1.65, 1.65, 25.0]))
    ]
    heading_deg = float(rng.uniform(0.0, 360.0))
    return {"eye_m": eye, "heading_rad": radians(heading_deg), **seen_from(solids, eye, heading_deg, HALF_DEG)}


def seen_from(solids: list[dict[str, Any]], eye: list[float], heading_deg: float, half_deg: int) -> dict[str, Any]:
    """Return what one stands in or on, and what is seen ahead, to the left and to the right."""
    outlines = {solid["id"]: Polygon(solid["footprint_en"]) for solid in solids}
    here = Point(eye[0], eye[1])
    under = sorted((outline.area, name) for name, outline in outlines.items() if outline.contains(here))
    standing = [s for s in solids if s["height_m"] > FLAT_M and not outlines[s["id"]].contains(here)]
    seen: dict[str, list[Glimpse]] = {}
    for turn_deg in range(-half_deg, half_deg + 1):
        for name, distance_m, shown_deg in _along(eye, heading_deg + turn_deg, standing, outlines):
            seen.setdefault(name, []).append((turn_deg, distance_m, shown_deg))
    return {"at": under[0][1] if under else None, "sights": _sights(seen)}


def _along(
    eye: list[float], bearing_deg: float, standing: list[dict[str, Any]], outlines: dict[str, Polygon]
) -> list[tuple[str, float, float]]:
    """Return what is seen in one direction: name, distance and how much of its height."""
    bearing = radians(bearing_deg)
    ray = LineString([eye[:2], (eye[0] + FAR_M * sin(bearing), eye[1] + FAR_M * cos(bearing))])
    crossings = []
    for solid in standing:
        crossed = ray.intersection(outlines[solid["id"]])
        if crossed.length > 0.0:
            parts = getattr(crossed, "geoms", [crossed])
            reaches = [hypot(x - eye[0], y - eye[1]) for part in parts for x, y in part.coords]
            crossings.append((min(reaches), max(reaches), solid))
    found, horizon_deg = [], -inf
    for near_m, far_m, solid in sorted(crossings, key=lambda crossing: crossing[0]):
        foot_m = solid["base_z_m"] - eye[2]
        top_m = foot_m + solid["height_m"]
        top_deg = max(degrees(atan2(top_m, near_m)), degrees(atan2(top_m, far_m)))
        shown_deg = top_deg - max(horizon_deg, degrees(atan2(foot_m, near_m)))
        horizon_deg = max(horizon_deg, top_deg)
        if shown_deg >= LEAST_DEG:
            found.append((solid["id"], near_m, shown_deg))
    return found


def _sights(seen: dict[str, list[Glimpse]]) -> list[dict[str, Any]]:
    sights = []
    ahead = min(
        ((abs(turn), -shown, far, name) for name, all_ in seen.items() for turn, far, shown in all_),
        default=(inf, 0.0, 0.0, ""),
    )
    if ahead[0] <= AHEAD_DEG:
        sights.append({"id": ahead[3], "side": "ahead", "distance_m": ahead[2]})
        del seen[ahead[3]]
    for side, sign in (("left", -1), ("right", 1)):
        parts = [(name, [g for g in all_ if g[0] * sign > 0]) for name, all_ in seen.items()]
        name, best = max(parts, key=lambda part: sum(shown for _, _, shown in part[1]), default=("", []))
        if best:
            sights.append({"id": name, "side": side, "distance_m": min(far for _, far, _ in best)})
            del seen[name]
    return sights


def test_the_golden_file_is_what_this_says() -> None:
    kept = json.loads(GOLDEN_PATH.read_text(encoding="utf-8"))
    fresh = json.loads(json.dumps(golden()))
    assert kept["solids"] == fresh["solids"]
    for one, other in zip(kept["views"], fresh["views"], strict=True):
        assert np.allclose(one["eye_m"], other["eye_m"])
        assert (one["at"], len(one["sights"])) == (other["at"], len(other["sights"]))
        for a, b in zip(one["sights"], other["sights"], strict=True):
            assert (a["id"], a["side"]) == (b["id"], b["side"])
            assert abs(a["distance_m"] - b["distance_m"]) < 1e-6


def test_the_views_are_of_many_kinds() -> None:
    views = json.loads(GOLDEN_PATH.read_text(encoding="utf-8"))["views"]
    assert len(views) >= 20
    assert len({round(view["heading_rad"] / (pi / 4)) % 8 for view in views}) == 8
    assert {len(view["sights"]) for view in views} >= {1, 3}
    assert len({sight["id"] for view in views for sight in view["sights"]}) > 10


if __name__ == "__main__":
    GOLDEN_PATH.write_text(json.dumps(golden(), indent=1) + "\n", encoding="utf-8")
