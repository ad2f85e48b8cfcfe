"""How every figure looks: colours, type, sizes, and files that are the same bytes on every run.

The nine motion models differ without colour too: the width of a line tells the position's index, its lightness the rotation's.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from typing import Any, Literal, TypeAlias

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from tracker.estimator import NO_MOTION_MODEL
from tracker.fuzzy import MOTION_MODELS

Kind: TypeAlias = Literal["svg", "png"]

INK = "#1c2126"
FAINT = "#6b747d"
GRID = "#dfe3e7"
PAPER = "#ffffff"
TRUTH = "#1c2126"
RAW_GPS = "#9aa3ab"
#: What is good and what is bad news; blue and orange part for every kind of colour vision, and differ in lightness.
BETTER, WORSE = "#1f5fa8", "#d9660a"

#: Hue by the position's index (grey rests, blue walks, orange doubles), lightness by the rotation's (0 dark to 2 light).
MODEL_COLOURS = {
    "P0R0": "#33383d",
    "P0R1": "#767d84",
    "P0R2": "#b9bfc5",
    "P1R0": "#0b3c7d",
    "P1R1": "#2f7fd0",
    "P1R2": "#93c4f2",
    "P2R0": "#862a00",
    "P2R1": "#d9660a",
    "P2R2": "#f6b76e",
    NO_MOTION_MODEL: FAINT,
}
_WIDTH_BY_POSITION = {"0": 1.0, "1": 2.2, "2": 4.0}
#: One colour, marker and dash for each rival, the same in every figure.
SELECTOR_COLOURS = {
    "cmm": "#2f7fd0",
    "famm": "#d9660a",
    "reduced": "#8a5a2b",
    "dfa": "#4d9a6a",
    "imm": "#7a4fa3",
    "precise": "#0e7c86",
    "truth": TRUTH,
}
SELECTOR_DASHES: dict[str, str | tuple[int, tuple[int, ...]]] = {
    "cmm": "-",
    "famm": (0, (5, 2)),
    "reduced": (0, (3, 1, 1, 1)),
    "dfa": (0, (1, 1)),
    "imm": "-.",
    "precise": (0, (8, 2, 2, 2)),
    "truth": "-",
}

WIDTH_IN = 7.2
_DPI = 130
_RC: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9.0,
    "axes.titlelocation": "left",
    "axes.titleweight": "bold",
    "axes.labelsize": 8.5,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "figure.facecolor": PAPER,
    "savefig.facecolor": PAPER,
    "svg.hashsalt": "agora",
    "svg.fonttype": "path",
    "path.simplify": True,
    "path.simplify_threshold": 0.4,
}


@dataclass(frozen=True)
class Picture:
    """A figure as it stands in a document."""

    name: str
    """Of its file, without ending."""
    kind: Kind
    data: bytes
    caption: str
    """What it shows, with its numbers; the first sentence is its title."""

    @property
    def alt(self) -> str:
        """What a reader without eyes for it is told: the caption's first sentence."""
        return self.caption.partition(". ")[0].rstrip(".")


@contextmanager
def house_style() -> Iterator[None]:
    """Draw in this style inside, whatever the machine's own settings."""
    with mpl.rc_context():
        mpl.rcdefaults()
        for key, value in _RC.items():
            mpl.rcParams[key] = value
        yield


def new_figure(height_in: float, width_in: float = WIDTH_IN) -> Figure:
    """Return an empty figure of page width that belongs to no window and no global state."""
    figure = Figure(figsize=(width_in, height_in), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def drawn(figure: Figure, name: str, caption: str, kind: Kind = "svg") -> Picture:
    """Return a figure as a file's bytes: the same for the same data, without a date or a version."""
    file = BytesIO()
    with house_style():
        if kind == "svg":
            figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
        else:
            figure.savefig(file, format="png", dpi=_DPI, metadata={"Software": None})
            file = _fewer_colours(file)
    return Picture(name, kind, file.getvalue(), caption)


def _fewer_colours(png: BytesIO) -> BytesIO:
    """Return a picture of line art with a palette of 256: a third of the size, and the eye sees no difference."""
    file = BytesIO()
    with Image.open(png) as image:
        image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(file, "PNG", optimize=True)
    return file


def model_width(model: str, scale: float = 1.0) -> float:
    """Return the width in points of a line drawn for a motion model."""
    return scale * _WIDTH_BY_POSITION.get(model[1:2], 1.0)


def model_handles(models: set[str] | None = None, scale: float = 1.0) -> list[Line2D]:
    """Return legend entries for the models that occur (None: all nine), in the paper's order."""
    names = [str(model) for model in MOTION_MODELS if models is None or str(model) in models]
    return [
        Line2D([], [], color=MODEL_COLOURS[name], linewidth=model_width(name, scale), solid_capstyle="butt", label=name)
        for name in names
    ]
