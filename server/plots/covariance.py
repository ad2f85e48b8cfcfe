"""The filter's own uncertainty as a map: the paper's figures "Changes in the state covariances"."""

from collections.abc import Sequence

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from server.plots.style import INK, PAPER, house_style, new_figure
from server.plots.trace import Array

_GROUPS = ("P", "V", "R", "Ω")
#: Below this share of the largest element a square is empty: the filter couples a value only with its own rate.
_FLOOR = 1e-9


def covariance_figure(sigmas: Sequence[tuple[str, Array]]) -> Figure:
    """Draw the size of each element of some state covariances, all on one logarithmic scale; darker is larger.

    Args:
        sigmas: Name and (12, 12) matrix in the paper's order P, V, R, Omega.
    """
    sizes = [np.abs(sigma) for _, sigma in sigmas]
    largest = max(float(size.max()) for size in sizes)
    least = min(float(size[size > largest * _FLOOR].min()) for size in sizes)
    with house_style():
        figure = new_figure(2.35)
        grid = figure.subplots(1, len(sigmas), squeeze=False).ravel()
        for axes, (name, _), size, letter in zip(grid, sigmas, sizes, "abcdefgh", strict=False):
            image = axes.imshow(
                np.where(size > largest * _FLOOR, size, np.nan), cmap="Blues", norm=LogNorm(least / 2.0, largest)
            )
            trace = float(np.trace(size))
            axes.set_title(f"({letter}) {name}\n      Σ variances {trace:.3g}", fontweight="normal", fontsize=7.5)
            axes.set_xticks(np.arange(4) * 3 + 1, _GROUPS)
            axes.set_yticks(np.arange(4) * 3 + 1, _GROUPS)
            axes.tick_params(length=0)
            axes.grid(visible=False)
            for edge in (2.5, 5.5, 8.5):
                axes.axhline(edge, color=PAPER, linewidth=1.5)
                axes.axvline(edge, color=PAPER, linewidth=1.5)
            axes.spines[:].set(visible=True, color=INK, linewidth=0.5)
        figure.colorbar(image, ax=grid.tolist(), shrink=0.75, pad=0.02, label="size, SI units")
    return figure


def covariance_caption(subject: str, sigmas: Sequence[tuple[str, Array]]) -> str:
    """Say how the variances compare, group by group, against the first matrix."""
    first = sigmas[0][1]
    parts = []
    for letter, (name, sigma) in zip("abcdefgh", sigmas, strict=False):
        changes = [_ratio(sigma, first, group) for group in range(4)]
        told = ", ".join(f"{group} × {change:.3g}" for group, change in zip(_GROUPS, changes, strict=True))
        parts.append(f"({letter}) {name}" + ("" if sigma is first else f": {told}"))
    return (
        f"State covariance of {subject}, its mean over the run. Darker is larger, on one logarithmic scale; empty squares are "
        "zero, since the filter couples each value only with its own rate. The factors compare the variances with those of (a). "
        + "; ".join(parts)
        + ". It is what the filter believes of itself, not its error."
    )


def _ratio(sigma: Array, first: Array, group: int) -> float:
    part = slice(3 * group, 3 * group + 3)
    return float(np.trace(sigma[part, part]) / np.trace(first[part, part]))
