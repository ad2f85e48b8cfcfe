"""A TOML table that knows its file and its path in it, so that every complaint names both."""

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from assets.errors import SiteError
from assets.records import LANGUAGE, PointEN, PointENZ, Texts

T = TypeVar("T")
_WORDS: Mapping[type, str] = {float: "number", str: "text", dict: "table", list: "list"}


class Table:
    """One table of a file. Its readers raise `SiteError` where a field is missing or of another kind."""

    def __init__(self, file: Path, values: Mapping[str, Any], where: str = "") -> None:
        self.file = file
        self.values = values
        self.where = where

    def path(self, key: str) -> str:
        """Return a field's full name in the file."""
        return f"{self.where}.{key}" if self.where else key

    def refuse(self, key: str, reason: str) -> SiteError:
        """Return the complaint about a field, ready to be raised; `reason` goes on after the field's name."""
        return SiteError(f"{self.file}: '{self.path(key)}' {reason}.")

    def get(self, key: str, kind: type[T]) -> T:
        """Return a field that must be there; an integer will do for a number."""
        if key not in self.values:
            raise SiteError(f"{self.file} has no '{self.path(key)}'; add it (a {_WORDS[kind]}).")
        value = self.values[key]
        if kind is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        if not isinstance(value, kind) or (isinstance(value, float) and not math.isfinite(value)):
            raise self.refuse(key, f"must be a {_WORDS[kind]}, not {value!r}")
        return value

    def filled(self, key: str) -> str:
        """Return a text that must be there and say something."""
        value = self.get(key, str)
        if not value.strip():
            raise self.refuse(key, "is empty; say something")
        return value

    def table(self, key: str) -> "Table":
        """Return a table that must be there."""
        return Table(self.file, self.get(key, dict), self.path(key))

    def optional(self, key: str) -> "Table":
        """Return a table, empty where there is none."""
        return self.table(key) if key in self.values else Table(self.file, {}, self.path(key))

    def tables(self, key: str) -> list["Table"]:
        """Return a list of tables that must be there."""
        rows = self.get(key, list)
        for row in rows:
            if not isinstance(row, dict):
                raise self.refuse(key, f"must hold tables, not {row!r}")
        return [Table(self.file, row, f"{self.path(key)}[{i}]") for i, row in enumerate(rows)]

    def number(self, key: str, low: float, high: float) -> float:
        """Return a number within limits, both included."""
        value = self.get(key, float)
        if not low <= value <= high:
            raise self.refuse(key, f"is {value:g}, outside {low:g} to {high:g}")
        return value

    def choice(self, key: str, allowed: tuple[str, ...]) -> Any:
        """Return a text that is one of those allowed."""
        value = self.get(key, str)
        if value not in allowed:
            raise self.refuse(key, f"is {value!r}, not one of {', '.join(allowed)}")
        return value

    def texts(self, key: str, languages: tuple[str, ...] = (LANGUAGE,)) -> Texts:
        """Return a text in the languages that it must have, and in all others that it has."""
        table = self.table(key)
        return {language: table.filled(language) for language in dict.fromkeys([*languages, *table.values])}

    def keys(self, key: str, known: Mapping[str, str]) -> tuple[str, ...]:
        """Return a list of source keys that must be there, hold at least one, and know them all."""
        names = self.get(key, list)
        if not names:
            raise self.refuse(key, "is empty; name at least one source")
        for name in names:
            if name not in known:
                raise self.refuse(key, f"names {name!r}, which [sources] of site.toml does not explain")
        return tuple(names)

    def corners(self, key: str) -> tuple[PointEN, ...]:
        """Return a list of at least three points that must be there."""
        return points(self.file, self.path(key), self.get(key, list))


def points(file: Path, path: str, corners: Any) -> tuple[PointEN, ...]:
    """Return a polygon's corners; `SiteError` where they are not at least three pairs of finite numbers."""
    pairs = corners if isinstance(corners, list) else []
    numbers = [x for c in pairs if isinstance(c, list) and len(c) == 2 for x in c if isinstance(x, int | float)]
    if len(pairs) < 3 or len(numbers) != 2 * len(pairs) or not all(math.isfinite(x) for x in numbers):
        raise SiteError(f"{file}: '{path}' must be at least three pairs of numbers [east, north].")
    return tuple((float(e), float(n)) for e, n in pairs)


def sights(file: Path, path: str, rows: list[Any]) -> tuple[PointENZ, ...]:
    """Return points with heights; `SiteError` where one is not three finite numbers."""
    for row in rows:
        numbers = row if isinstance(row, list) else []
        if len(numbers) != 3 or not all(isinstance(x, int | float) and math.isfinite(x) for x in numbers):
            raise SiteError(f"{file}: '{path}' must hold triples of numbers [east, north, up], not {row!r}.")
    return tuple((float(e), float(n), float(z)) for e, n, z in rows)


def read_table(file: Path) -> Table:
    """Read a file.

    Raises:
        SiteError: It is missing, cannot be read, or is no TOML.
    """
    try:
        return Table(file, tomllib.loads(file.read_text(encoding="utf-8")))
    except FileNotFoundError as exc:
        raise SiteError(f"{file} does not exist; name a folder that holds a site.toml and a monuments.toml.") from exc
    except OSError as exc:
        raise SiteError(f"{file} cannot be read ({exc.strerror}); check the path and its permissions.") from exc
    except UnicodeDecodeError as exc:
        raise SiteError(f"{file} is not UTF-8 text; save it as UTF-8.") from exc
    except tomllib.TOMLDecodeError as exc:
        raise SiteError(f"{file} is not valid TOML: {str(exc).rstrip('.')}.") from exc
