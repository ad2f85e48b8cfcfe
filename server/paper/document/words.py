"""Numbers in sentences."""

from collections.abc import Sequence

_SMALL = ("none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def count(number: int) -> str:
    """Return a small number as a word."""
    return _SMALL[number] if 0 <= number < len(_SMALL) else str(number)


def listed(words: Sequence[str]) -> str:
    """Return `a, b and c`; `none` of nothing."""
    if not words:
        return "none"
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def percent(ratio: float) -> str:
    """Return a ratio as a signed change: `+3.1 %`, `−0.5 %`."""
    return f"{100.0 * (ratio - 1.0):+.1f} %".replace("-", "−")


def cell_name(dataset: int, sensors: str) -> str:
    """Return a cell of the paper's tables in words."""
    return f"dataset {dataset} {'with' if sensors.startswith('camera') else 'without'} the camera"


def span(values: Sequence[float], decimals: int) -> str:
    """Return `0.97 to 1.03`, or the one number where both are the same."""
    low, high = f"{min(values):.{decimals}f}", f"{max(values):.{decimals}f}"
    return low if low == high else f"{low} to {high}"
