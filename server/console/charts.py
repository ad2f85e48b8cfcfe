"""Charts of one walk in viser's panel: innovations, doubt, and what was refused."""

from typing import Any, Final

import numpy as np

from server.console.status import rejected_of
from server.console.walk import Walk
from tracker.measurements import Matrix

_METRES, _DEGREES = "#f2b25c", "#7fc4e8"
_AXIS: Final = {"stroke": "#b5aca0", "grid": {"stroke": "#4a453f", "width": 1}}
_NO_UPDATES: Final = "*This estimator makes no measurements of its own: it has no innovations.*"


class Charts:
    """The tab."""

    def __init__(self, gui: Any) -> None:
        """Build it in the container that is open."""
        self._gui = gui
        self._note = gui.add_markdown("")
        self._innovations = _chart(gui, "Innovation: measured less predicted", ("position, m", "rotation, °"))
        self._doubts = _chart(gui, "Sure to (1σ)", ("position, m", "heading, °"))
        self._rejected = gui.add_markdown("")
        self._shown: tuple[object, ...] = ()

    def show(self, walk: Walk) -> None:
        """Show a walk as it is now."""
        innovations, doubts = walk.history.innovations(), walk.history.doubts()
        shown = (walk.name, innovations.tobytes(), doubts.tobytes(), tuple(walk.history.rejected.items()))
        if shown == self._shown:
            return
        self._shown = shown
        self._note.content = "" if innovations.size else _NO_UPDATES
        self._innovations.visible = bool(innovations.size)
        self._innovations.data, self._doubts.data = _drawn(innovations), _drawn(doubts)
        self._rejected.content = rejected_of(walk)


def _chart(gui: Any, title: str, names: tuple[str, str]) -> Any:
    return gui.add_uplot(
        data=_drawn(np.zeros((3, 0))),
        series=(
            {"label": "s"},
            {"label": names[0], "stroke": _METRES, "width": 1.5, "scale": "m"},
            {"label": names[1], "stroke": _DEGREES, "width": 1.5, "scale": "deg"},
        ),
        title=title,
        scales={"x": {"time": False}, "m": {"auto": True}, "deg": {"auto": True}},
        axes=(
            _AXIS,
            _AXIS | {"scale": "m", "stroke": _METRES},
            _AXIS | {"scale": "deg", "side": 1, "stroke": _DEGREES, "grid": {"show": False}},
        ),
        height=200,
        padding=(8, 0, 0, 0),
    )


def _drawn(columns: Matrix) -> tuple[Matrix, ...]:
    """Return what uPlot takes, which must not be empty."""
    return tuple(columns if columns.shape[1] else np.zeros((3, 1)))
