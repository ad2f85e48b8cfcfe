"""A frozen dataclass as one table of a TOML file that people read and edit: every field says what it is and what it may be.

Reading is strict, because what a hand has mistyped must not steer a filter; writing and reading again gives the same value.
"""

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from datetime import date
from math import inf, isfinite
from typing import Any, Literal, TypeAlias, TypeVar, cast, get_args, get_origin, get_type_hints

from tracker.errors import InputError

Rows: TypeAlias = tuple[tuple[float, ...], ...]
"""A matrix, row by row: unlike an array it can be compared and cannot be written to."""

_T = TypeVar("_T")
_LONGEST_LINE = 118


@dataclass(frozen=True)
class Kind:
    """What a value may be: it stands in the field's annotation, `Annotated[float, Kind("focal length", 1.0, 1e6)]`."""

    about: str
    """The comment beside the value."""
    low: float = -inf
    high: float = inf
    shape: tuple[int, ...] = ()
    """() for one number, (3,) for a vector, (4, 4) for a matrix; -1 for any length up to 16."""
    words: tuple[str, ...] = ()
    """The texts that are allowed; none for any."""


def _kinds(sheet: type[Any]) -> dict[str, tuple[type[Any], Kind]]:
    """Return for each field the type of its value, or of each of its numbers, and what it may be."""
    hints = {name: get_args(hint) for name, hint in get_type_hints(sheet, include_extras=True).items()}
    return {name: (_plain(base), kind) for name, (base, kind) in hints.items()}


def _plain(base: Any) -> type[Any]:
    if base in (int, date):
        return cast(type[Any], base)
    return str if base is str or get_origin(base) is Literal else float


def read_sheet(sheet: type[_T], table: object, where: str, remedy: str) -> _T:
    """Return the dataclass `sheet` from a table of a TOML file.

    Args:
        sheet: A dataclass whose fields all are annotated with a `Kind`.
        table: What the TOML reader made of it.
        where: File and table, for messages.
        remedy: What to do, for messages; a sentence without its capital and full stop.

    Raises:
        InputError: A key is missing or unknown, or a value has another type, size or range.
    """
    if not isinstance(table, Mapping):
        raise InputError(f"{where} is not a table: {remedy}.")
    kinds = _kinds(sheet)
    needed = {f.name for f in fields(sheet) if f.default is MISSING}  # type: ignore[arg-type]
    for name in table:
        if name not in kinds:
            raise InputError(f"{where} has the unknown key {name!r}, expected {', '.join(kinds)}: {remedy}.")
    for name in kinds:
        if name in needed and name not in table:
            raise InputError(f"{where} lacks {name} ({kinds[name][1].about}): {remedy}.")
    return sheet(**{name: _value(value, *kinds[name], f"{where} {name}", remedy) for name, value in table.items()})


def _value(value: object, type_: type[Any], kind: Kind, where: str, remedy: str) -> Any:
    if type_ is float:
        return _numbers(value, kind, kind.shape, where, remedy)
    if type(value) is not type_:
        raise InputError(f"{where} is {_shown(value)}, expected {_NAMES[type_]}: {remedy}.")
    if isinstance(value, str) and kind.words and value not in kind.words:
        raise InputError(f"{where} is {_shown(value)}, expected one of {', '.join(kind.words)}: {remedy}.")
    if isinstance(value, int) and not kind.low <= value <= kind.high:
        raise InputError(f"{where} is {value}, expected {kind.low:g} to {kind.high:g}: {remedy}.")
    return value


_NAMES = {str: "a text in quotes", int: "a whole number", date: "a date such as 2026-05-01"}


def _numbers(value: object, kind: Kind, shape: tuple[int, ...], where: str, remedy: str) -> Any:
    if not shape:
        if not isinstance(value, int | float) or isinstance(value, bool):
            raise InputError(f"{where} is {_shown(value)}, expected a number: {remedy}.")
        if not (isfinite(value) and kind.low <= value <= kind.high):
            raise InputError(f"{where} is {value:g}, expected {kind.low:g} to {kind.high:g}: {remedy}.")
        return float(value)
    size = f"{shape[0]}" if shape[0] >= 0 else "at most 16"
    is_right = isinstance(value, list) and (len(value) == shape[0] or (shape[0] < 0 and len(value) <= 16))
    if not is_right or not isinstance(value, list):
        raise InputError(
            f"{where} is {_shown(value)}, expected {size} {'rows' if len(shape) > 1 else 'numbers'} in brackets: {remedy}."
        )
    return tuple(_numbers(part, kind, shape[1:], where, remedy) for part in value)


def _shown(value: object) -> str:
    shown = repr(value)
    return shown if len(shown) <= 60 else shown[:57] + "..."


def sheet_lines(name: str, sheet: object) -> list[str]:
    """Return the lines of `[name]` and what is in it, each value with its comment."""
    lines, kinds = [f"[{name}]"], _kinds(type(sheet))
    for f in fields(sheet):  # type: ignore[arg-type]
        about, value = kinds[f.name][1].about, getattr(sheet, f.name)
        if isinstance(value, tuple) and value and isinstance(value[0], tuple):
            lines += [f"{f.name} = [ # {about}", *(f"    {_numbers_text(row)}," for row in value), "]"]
            continue
        line = f"{f.name} = {_text(value)}"
        fits = len(line) + len(about) + 3 <= _LONGEST_LINE
        lines += [f"{line} # {about}"] if fits else [f"# {about}", line]
    return lines


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return _numbers_text(value)
    if isinstance(value, date):
        return value.isoformat()
    if isinstance(value, str):
        return '"' + "".join(_escaped(letter) for letter in value) + '"'
    return repr(value)


def _escaped(letter: str) -> str:
    if letter in '"\\':
        return "\\" + letter
    return f"\\u{ord(letter):04X}" if ord(letter) < 0x20 or letter == "\x7f" else letter


def _numbers_text(values: Sequence[float]) -> str:
    return "[" + ", ".join(repr(value) for value in values) + "]"
