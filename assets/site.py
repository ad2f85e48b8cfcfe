"""A heritage site as data: `site.toml` and `monuments.toml` read into the values of `assets.records`, and checked.

The files are written by people and hold degrees where people think in degrees (`heading_deg`, `azimuth_deg`).
"""

import math
from pathlib import Path

from assets.checks import check_landmarks, check_monuments, check_tour
from assets.monument_reader import FURTHEST_M, read_monument
from assets.records import (
    KINDS,
    LANGUAGE,
    LANGUAGES,
    Confidence,
    Epoch,
    Evidence,
    Figure,
    Footprint,
    Landmark,
    Monument,
    Order,
    Origin,
    Reading,
    Site,
    Stop,
    Texts,
    Variant,
    View,
)
from assets.table import Table, points, read_table, sights

__all__ = [
    "KINDS",
    "LANGUAGE",
    "LANGUAGES",
    "Confidence",
    "Epoch",
    "Evidence",
    "Figure",
    "Footprint",
    "Landmark",
    "Monument",
    "Order",
    "Origin",
    "Reading",
    "Site",
    "Stop",
    "Texts",
    "Variant",
    "View",
    "load_site",
]


def load_site(folder: Path) -> Site:
    """Read a site's folder.

    Raises:
        SiteError: A file is missing, is no TOML, or lacks something or holds something impossible; one sentence says what.
    """
    top = read_table(folder / "site.toml")
    places = read_table(folder / "monuments.toml")
    sources = top.table("sources")
    titles = {key: sources.filled(key) for key in sources.values}
    site = Site(
        id=top.filled("id"),
        name=top.texts("name"),
        folder=folder,
        origin=_origin(top.table("origin")),
        azimuth_rad=math.radians(top.table("axes").number("azimuth_deg", 0.0, 360.0)),
        time_zone=top.get("time_zone", str),
        eye_height_m=top.number("eye_height_m", 0.5, 2.5),
        attribution=top.get("attribution", str),
        licence=top.get("licence", str),
        sources=titles,
        default_view=_view(top.table("default_view")),
        tour=tuple(_stop(row) for row in top.tables("tour")),
        ways=tuple(points(top.file, f"ways[{i}]", way) for i, way in enumerate(top.get("ways", list))),
        sights=sights(top.file, "sights", top.get("sights", list)),
        landmarks=tuple(_landmark(row) for row in top.tables("landmark")) if "landmark" in top.values else (),
        terrain=top.get("terrain", dict),
        landscape=top.get("landscape", dict) if "landscape" in top.values else {},
        monuments=tuple(read_monument(places.table(key), key, titles) for key in places.values),
    )
    check_monuments(places.file, site.monuments)
    check_tour(top.file, site.tour, site.monuments)
    check_landmarks(top.file, site.landmarks, site.monuments)
    return site


def _origin(table: Table) -> Origin:
    return Origin(
        table.number("lat_deg", -90.0, 90.0),
        table.number("lon_deg", -180.0, 180.0),
        table.number("h_ellipsoid_m", -500.0, 9000.0),
        table.number("sigma_h_m", 0.0, 1000.0),
    )


def _view(table: Table) -> View:
    return View(
        id=table.filled("id"),
        name=table.texts("name"),
        e_m=table.number("e_m", -FURTHEST_M, FURTHEST_M),
        n_m=table.number("n_m", -FURTHEST_M, FURTHEST_M),
        heading_rad=math.radians(table.number("heading_deg", 0.0, 360.0)),
        pitch_rad=math.radians(table.number("pitch_deg", -90.0, 90.0)),
    )


def _stop(table: Table) -> Stop:
    view = _view(table)
    return Stop(
        id=view.id,
        name=table.texts("name", LANGUAGES),
        e_m=view.e_m,
        n_m=view.n_m,
        heading_rad=view.heading_rad,
        pitch_rad=view.pitch_rad,
        monument=table.get("monument", str),
        text=table.texts("text", LANGUAGES),
    )


def _landmark(table: Table) -> Landmark:
    (point,) = sights(table.file, table.path("point_m"), [table.get("point_m", list)])
    return Landmark(table.filled("id"), table.texts("name", LANGUAGES), table.get("monument", str), point)
