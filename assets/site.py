"""A heritage site as data: `site.toml` and `monuments.toml` read into frozen values, and nothing else.

Lengths are metres in the site frame (ENU at the origin, z = 0 on the paving). The files are written by people and hold
degrees where people think in degrees (`heading_deg`, `azimuth_deg`); the values here are radians.
"""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypeVar, get_args

from assets.errors import SiteError

Epoch = Literal["roman", "today"]
Evidence = Literal["attested", "inferred", "hypothetical"]
Confidence = Literal["H", "M", "L", "D"]
PointEN: TypeAlias = tuple[float, float]
Texts: TypeAlias = Mapping[str, str]
"""One text per language code: `en`, `tr`."""
T = TypeVar("T")


@dataclass(frozen=True)
class Origin:
    """Where the site frame is laid on the Earth (WGS84)."""

    lat_deg: float
    lon_deg: float
    h_ellipsoid_m: float
    sigma_h_m: float
    """How well the height above the ellipsoid is known."""


@dataclass(frozen=True)
class View:
    """A place to stand and a direction to look in: the start view, or a stop of the guided tour."""

    id: str
    name: Texts
    e_m: float
    n_m: float
    heading_rad: float
    """Clockwise from true north."""
    pitch_rad: float
    """Up is positive."""


@dataclass(frozen=True)
class Figure:
    """One measure of a monument, with where it comes from and how far to trust it."""

    value: float
    unit: str
    source: str
    confidence: Confidence
    """H: excavation publication or two sources; M: one decent source or measured on the map; L: popular page; D: design value."""
    uncertainty: float


@dataclass(frozen=True)
class Footprint:
    """Corners (east, north), counter-clockwise from the south-west corner, not repeated at the end."""

    corners_en_m: tuple[PointEN, ...]
    source: str
    confidence: Confidence
    uncertainty_m: float


@dataclass(frozen=True)
class Monument:
    """One building, street or open place."""

    id: str
    name: Texts
    caption: Texts
    kind: str
    """Which builder of `assets.roman` draws it."""
    epochs: tuple[Epoch, ...]
    """The models that show it; empty for one that is known too badly to be shown."""
    evidence: Evidence
    sources: tuple[str, ...]
    footprint: Footprint
    figures: Mapping[str, Figure]

    @property
    def base_z_m(self) -> float:
        """Level of the footprint above the square's paving."""
        return self.figures["base_z_m"].value

    @property
    def height_m(self) -> float:
        """From `base_z_m` to the highest point."""
        return self.figures["height_m"].value

    def measure(self, name: str) -> float:
        """Return a figure's value in its unit; `SiteError` where the data lack what the monument's kind needs."""
        if name not in self.figures:
            raise SiteError(
                f"monument '{self.id}' of kind '{self.kind}' needs the figure '{name}'; add it to monuments.toml."
            )
        return self.figures[name].value


@dataclass(frozen=True)
class Site:
    """Everything that is known about one site."""

    id: str
    name: Texts
    folder: Path
    origin: Origin
    azimuth_rad: float
    """Of the `agora` frame's u axis, clockwise from true north."""
    time_zone: str
    eye_height_m: float
    attribution: str
    licence: str
    default_view: View
    tour: tuple[View, ...]
    ways: tuple[tuple[PointEN, ...], ...]
    """Closed rounds that visitors walk; whatever stands today keeps clear of them, and of all that a convex one encloses."""
    terrain: Mapping[str, Any]
    """The ground's description as `assets.terrain` reads it."""
    monuments: tuple[Monument, ...]

    def monument(self, monument_id: str) -> Monument:
        """The monument of that id; `KeyError` where there is none."""
        for monument in self.monuments:
            if monument.id == monument_id:
                return monument
        raise KeyError(monument_id)

    def shown_in(self, epoch: Epoch) -> tuple[Monument, ...]:
        """The monuments that the model of that epoch shows."""
        return tuple(m for m in self.monuments if epoch in m.epochs)


class _Table:
    """A TOML table that knows its file and its path in it, so that every complaint names both."""

    def __init__(self, file: Path, values: Mapping[str, Any], where: str = "") -> None:
        self.file = file
        self.values = values
        self.where = where

    def path(self, key: str) -> str:
        return f"{self.where}.{key}" if self.where else key

    def get(self, key: str, kind: type[T]) -> T:
        if key not in self.values:
            raise SiteError(f"{self.file} has no '{self.path(key)}'; add it (a {_WORDS[kind]}).")
        value = self.values[key]
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or (isinstance(value, float) and not math.isfinite(value)):
            raise SiteError(f"{self.file}: '{self.path(key)}' must be a {_WORDS[kind]}, not {value!r}.")
        return value

    def table(self, key: str) -> "_Table":
        return _Table(self.file, self.get(key, dict), self.path(key))

    def tables(self, key: str) -> list["_Table"]:
        rows = self.get(key, list)
        for row in rows:
            if not isinstance(row, dict):
                raise SiteError(f"{self.file}: '{self.path(key)}' must hold tables, not {row!r}.")
        return [_Table(self.file, row, f"{self.path(key)}[{i}]") for i, row in enumerate(rows)]

    def number(self, key: str, low: float, high: float) -> float:
        value = self.get(key, float)
        if not low <= value <= high:
            raise SiteError(f"{self.file}: '{self.path(key)}' is {value:g}, outside {low:g} to {high:g}.")
        return value

    def choice(self, key: str, allowed: tuple[str, ...]) -> Any:
        value = self.get(key, str)
        if value not in allowed:
            raise SiteError(f"{self.file}: '{self.path(key)}' is {value!r}, not one of {', '.join(allowed)}.")
        return value

    def texts(self, key: str) -> Texts:
        table = self.table(key)
        languages = (LANGUAGE, *(key for key in table.values if key != LANGUAGE))
        return {language: table.get(language, str) for language in languages}


LANGUAGE = "en"
"""The language that every text must have; others stand beside it."""
_WORDS: Mapping[type, str] = {float: "number", str: "text", dict: "table", list: "list"}


def load_site(folder: Path) -> Site:
    """Read a site's folder.

    Raises:
        SiteError: A file is missing, is no TOML, or lacks something or holds something impossible; one sentence says what.
    """
    top = _read(folder / "site.toml")
    origin = top.table("origin")
    places = _read(folder / "monuments.toml")
    return Site(
        id=top.get("id", str),
        name=top.texts("name"),
        folder=folder,
        origin=Origin(
            origin.number("lat_deg", -90.0, 90.0),
            origin.number("lon_deg", -180.0, 180.0),
            origin.number("h_ellipsoid_m", -500.0, 9000.0),
            origin.number("sigma_h_m", 0.0, 1000.0),
        ),
        azimuth_rad=math.radians(top.table("axes").number("azimuth_deg", 0.0, 360.0)),
        time_zone=top.get("time_zone", str),
        eye_height_m=top.number("eye_height_m", 0.5, 2.5),
        attribution=top.get("attribution", str),
        licence=top.get("licence", str),
        default_view=_view(top.table("default_view")),
        tour=tuple(_view(row) for row in top.tables("tour")),
        ways=tuple(_corners(top.file, f"ways[{i}]", way) for i, way in enumerate(top.get("ways", list))),
        terrain=top.get("terrain", dict),
        monuments=tuple(_monument(places.table(key), key) for key in places.values),
    )


def _read(file: Path) -> _Table:
    try:
        return _Table(file, tomllib.loads(file.read_text(encoding="utf-8")))
    except FileNotFoundError as exc:
        raise SiteError(f"{file} does not exist; name a folder that holds a site.toml and a monuments.toml.") from exc
    except OSError as exc:
        raise SiteError(f"{file} cannot be read ({exc.strerror}); check the path and its permissions.") from exc
    except UnicodeDecodeError as exc:
        raise SiteError(f"{file} is not UTF-8 text; save it as UTF-8.") from exc
    except tomllib.TOMLDecodeError as exc:
        raise SiteError(f"{file} is not valid TOML: {str(exc).rstrip('.')}.") from exc


def _view(table: _Table) -> View:
    return View(
        id=table.get("id", str),
        name=table.texts("name"),
        e_m=table.number("e_m", -5000.0, 5000.0),
        n_m=table.number("n_m", -5000.0, 5000.0),
        heading_rad=math.radians(table.number("heading_deg", 0.0, 360.0)),
        pitch_rad=math.radians(table.number("pitch_deg", -90.0, 90.0)),
    )


def _monument(table: _Table, monument_id: str) -> Monument:
    figures = table.table("figures")
    epochs = tuple(table.get("epochs", list))
    if not set(epochs) <= set(get_args(Epoch)):
        raise SiteError(f"{table.file}: '{table.path('epochs')}' may hold only {', '.join(get_args(Epoch))}.")
    monument = Monument(
        id=monument_id,
        name=table.texts("name"),
        caption=table.texts("caption"),
        kind=table.get("kind", str),
        epochs=epochs,
        evidence=table.choice("evidence", get_args(Evidence)),
        sources=tuple(str(s) for s in table.get("sources", list)),
        footprint=_footprint(table.table("footprint")),
        figures={name: _figure(figures.table(name)) for name in figures.values},
    )
    for name in ("base_z_m", "height_m"):
        if name not in monument.figures:
            raise SiteError(f"{table.file} has no '{figures.path(name)}'; add it (a figure in metres).")
    return monument


def _figure(table: _Table) -> Figure:
    return Figure(
        value=table.get("value", float),
        unit=table.get("unit", str),
        source=table.get("source", str),
        confidence=table.choice("confidence", get_args(Confidence)),
        uncertainty=table.number("uncertainty", 0.0, 1000.0),
    )


def _footprint(table: _Table) -> Footprint:
    return Footprint(
        corners_en_m=_corners(table.file, table.path("value"), table.get("value", list)),
        source=table.get("source", str),
        confidence=table.choice("confidence", get_args(Confidence)),
        uncertainty_m=table.number("uncertainty", 0.0, 1000.0),
    )


def _corners(file: Path, path: str, corners: Any) -> tuple[PointEN, ...]:
    pairs = corners if isinstance(corners, list) else []
    numbers = [x for c in pairs if isinstance(c, list) and len(c) == 2 for x in c if isinstance(x, int | float)]
    if len(pairs) < 3 or len(numbers) != 2 * len(pairs) or not all(math.isfinite(x) for x in numbers):
        raise SiteError(f"{file}: '{path}' must be at least three pairs of numbers [east, north].")
    return tuple((float(e), float(n)) for e, n in pairs)
