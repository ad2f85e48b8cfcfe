"""JSON files of figures that are the same on any machine, and small: few digits, one line for each row."""

import json
from math import isfinite
from pathlib import Path
from typing import Any

#: More than any figure of a study is good for, fewer than two machines' arithmetic may differ in.
DIGITS = 5
#: A longer object has one entry a line.
_LONGEST_LINE = 200


def rounded(value: Any, digits: int = DIGITS) -> Any:
    """Return a value as JSON holds it, its floats to so many significant digits; what is no number becomes None."""
    match value:
        case bool() | int() | str() | None:
            return value
        case float():
            return float(f"{value:.{digits}g}") if isfinite(value) else None
        case dict():
            return {str(key): rounded(entry, digits) for key, entry in value.items()}
        case list() | tuple():
            return [rounded(entry, digits) for entry in value]
    raise TypeError(f"expected what JSON can hold, got {type(value).__name__}")


def write_figures(path: Path, figures: dict[str, Any]) -> None:
    """Write figures, rounded: a list of rows has one row a line, so that a difference between two files can be read."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(_text(rounded(figures)) + "\n", encoding="utf-8")


def _text(value: Any) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + ",\n".join(map(_line, value)) + "\n]"
    if isinstance(value, dict) and len(_line(value)) > _LONGEST_LINE:
        return "{\n" + ",\n".join(f"{_line(key)}: {_text(entry)}" for key, entry in value.items()) + "\n}"
    return _line(value)


def _line(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)
