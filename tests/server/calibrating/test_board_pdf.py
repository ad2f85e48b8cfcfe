"""The printed board: its rectangles, drawn as a printer would, are the board in true size."""

import re

import numpy as np
import pytest

from server.calibrating.board_pdf import board_pdf
from tracker.calibrate.board import Board
from tracker.errors import InputError

PX_PER_MM = 6.0


def drawn(pdf: bytes, width_mm: float, height_mm: float) -> np.ndarray:
    """Fill the page's rectangles; its one transformation lays millimetres downwards."""
    page = np.full((round(height_mm * PX_PER_MM), round(width_mm * PX_PER_MM)), 255, np.uint8)
    for x, y, w, h in re.findall(rb"([\d.]+) ([\d.]+) ([\d.]+) ([\d.]+) re f", pdf):
        left, top, right, bottom = (
            round(float(v) * PX_PER_MM) for v in (x, y, float(x) + float(w), float(y) + float(h))
        )
        page[top:bottom, left:right] = 0
    return page


@pytest.mark.parametrize(("paper", "size_mm"), [("a4", (297.0, 210.0)), ("letter", (279.4, 215.9))])
def test_the_board_is_on_the_page_in_true_size(paper: str, size_mm: tuple[float, float]) -> None:
    board = Board()
    pdf = board_pdf(board, paper)  # type: ignore[arg-type]
    box = re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", pdf)
    assert box is not None
    assert [float(v) / 72 * 25.4 for v in box.groups()] == pytest.approx(size_mm, abs=0.01)
    scale = re.search(rb"\n([\d.]+) 0 0 -([\d.]+) 0 [\d.]+ cm", pdf)
    assert scale is not None
    assert [float(v) for v in scale.groups()] == pytest.approx([72 / 25.4] * 2)
    view = board.find(drawn(pdf, *size_mm), 0)
    assert view is not None
    assert len(view.numbers) == 40
    expected_mm = board.corners_m[view.numbers, :2] * 1e3
    seen_mm = view.points_px / PX_PER_MM
    np.testing.assert_allclose(seen_mm - seen_mm[0], expected_mm - expected_mm[0], atol=0.05)


def test_the_bar_is_a_hundred_millimetres_long() -> None:
    widths = [float(w) for w in re.findall(rb"[\d.]+ [\d.]+ ([\d.]+) 1 re f", board_pdf(Board(), "a4"))]
    assert widths == [100.0]


def test_the_cross_reference_table_is_right() -> None:
    pdf = board_pdf(Board(), "a4")
    start = int(pdf.rpartition(b"startxref\n")[2].split()[0])
    assert pdf[start : start + 4] == b"xref"
    for number, place in enumerate(re.findall(rb"(\d{10}) 00000 n", pdf), 1):
        assert pdf[int(place) :].startswith(b"%d 0 obj" % number)


def test_a_board_that_is_too_large_is_refused_with_a_size_that_fits() -> None:
    with pytest.raises(InputError, match=r"do not fit on A4: give `--square 30\.5`") as caught:
        board_pdf(Board(square_m=0.040), "a4")
    assert "--paper a3" in str(caught.value)
    assert board_pdf(Board(square_m=0.0305), "a4")
    assert board_pdf(Board(square_m=0.040), "a3")
