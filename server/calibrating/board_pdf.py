"""The calibration board as a PDF in true size: vector graphics, with a bar to measure whether the printer kept the size."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from tracker.calibrate.board import CELLS, Board
from tracker.errors import InputError

Paper = Literal["a4", "letter", "a3"]
#: Width and height in millimetres, lying on the long side.
_PAPERS: dict[Paper, tuple[float, float]] = {"a4": (297.0, 210.0), "letter": (279.4, 215.9), "a3": (420.0, 297.0)}
#: What printers leave white.
_MARGIN_MM = 6.0
_FOOT_MM = 13.0
_POINTS_PER_MM = 72.0 / 25.4
_BAR_MM = 100


def board_pdf(board: Board, paper: Paper) -> bytes:
    """Return the board, one page.

    Raises:
        InputError: The board is larger than the paper.
    """
    width, height = _PAPERS[paper]
    square = board.square_m * 1e3
    across, down = board.columns * square, board.rows * square
    if across > width - 2 * _MARGIN_MM or down > height - 2 * _MARGIN_MM - _FOOT_MM:
        fits = min((width - 2 * _MARGIN_MM) / board.columns, (height - 2 * _MARGIN_MM - _FOOT_MM) / board.rows)
        raise InputError(
            f"{board.columns} by {board.rows} squares of {square:g} mm do not fit on {paper.upper()}: "
            f"give `--square {np.floor(fits * 2) / 2:g}`, or `--paper a3`."
        )
    left, top = 0.5 * (width - across), 0.5 * (height - _FOOT_MM - down) + 0.5 * _MARGIN_MM
    content = "\n".join(
        [
            f"{_POINTS_PER_MM:.10f} 0 0 {-_POINTS_PER_MM:.10f} 0 {height * _POINTS_PER_MM:.6f} cm",  # millimetres, downwards
            "0 g",
            *_cells(board, left, top, square / CELLS),
            *_foot(board, left, top + down + 5.0),
        ]
    )
    return _page(content, width * _POINTS_PER_MM, height * _POINTS_PER_MM)


def _cells(board: Board, left: float, top: float, cell: float) -> Iterator[str]:
    """Yield the black cells as rectangles, as long across as they can be: seams between cells would show as hairlines."""
    for row, line in enumerate(~board.cells()):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], line, [False]]).astype(int)))
        for begin, end in edges.reshape(-1, 2).tolist():
            # a hair taller than it is, for the same reason
            yield f"{left + begin * cell:.4f} {top + row * cell:.4f} {(end - begin) * cell:.4f} {cell * 1.002:.4f} re f"


def _foot(board: Board, left: float, y: float) -> Iterator[str]:
    """Yield the scale bar and what to know."""
    yield f"{left:.4f} {y:.4f} {_BAR_MM} 1 re f"
    for place in range(0, _BAR_MM + 1, 10):
        tall = 3.0 if place % 50 == 0 else 2.0
        yield f"{left + place - 0.1:.4f} {y - tall + 1.0:.4f} 0.2 {tall} re f"
    square = board.square_m * 1e3
    text = (
        f"This bar is {_BAR_MM} mm long: if not, print at 100 %, without fitting to the page.   "
        f"Agora board {board.columns} x {board.rows}, squares {square:g} mm, {board.dictionary}.   Glue it to something flat."
    )
    escaped = text.replace("\\", r"\\").replace("(", r"\(").replace(")", r"\)")
    # text stands upright only where the axis points up
    yield f"BT 1 0 0 -1 {left:.4f} {y + 6.0:.4f} Tm /F1 3.1 Tf ({escaped}) Tj ET"


def _page(content: str, width_pt: float, height_pt: float) -> bytes:
    """Return a PDF of one page."""
    stream = content.encode("latin-1")
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width_pt:.4f} {height_pt:.4f}] /Contents 4 0 R "
        "/Resources << /Font << /F1 5 0 R >> >> >>".encode(),
        b"<< /Length %d >>\nstream\n%s\nendstream" % (len(stream), stream),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
    ]
    data, places = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", []
    for number, body in enumerate(objects, 1):
        places.append(len(data))
        data += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    trailer = b"trailer\n<< /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (len(objects) + 1, len(data))
    return data + b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1) + table + trailer
