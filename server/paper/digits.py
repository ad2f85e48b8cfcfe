"""JSON files of figures that are the same on any machine, and small: few digits, one line for each row."""

import json
from math import isfinite
from pathlib import Path
from typing import Any

#: More than any figure of a study is good for, fewer than two machines' arithmetic may differ in.
DIGITS = 5


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
    """Write figures: lists of rows one row a line, everything else as it is, rounded."""
    parts = []
    for key, value in rounded(figures).items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            lines = ",\n".join(json.dumps(row, separators=(",", ":"), allow_nan=False) for row in value)
            text = f"[\n{lines}\n]"
        else:
            text = json.dumps(value, indent=1, allow_nan=False)
        parts.append(f"{json.dumps(key)}: {text}")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")
