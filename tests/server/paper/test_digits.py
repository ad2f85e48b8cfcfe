"""Files of figures: five digits, one row a line, the same bytes for the same figures."""

import json
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from server.paper.digits import rounded, write_figures


def test_floats_keep_five_digits_and_the_rest_stays() -> None:
    """Counts, names and truth values are no measurements."""
    value = {
        "a": 1.23456789,
        "b": 123456789,
        "c": [True, None, "1.23456789", (0.000123456789,)],
        4: np.float64(9.87654321),
    }
    assert rounded(value) == {"a": 1.2346, "b": 123456789, "c": [True, None, "1.23456789", [0.00012346]], "4": 9.8765}


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_what_is_no_number_is_none(value: float) -> None:
    """JSON has no NaN."""
    assert rounded([value]) == [None]


def test_what_json_cannot_hold_is_refused() -> None:
    """Rather than written as its repr."""
    with pytest.raises(TypeError, match="ndarray"):
        rounded({"a": np.zeros(3)})


def test_a_row_is_a_line(tmp_path: Path) -> None:
    """So that a difference between two studies can be read."""
    path = tmp_path / "new" / "study.json"
    rows = [{"seed": seed, "x": seed / 3.0} for seed in range(20)]
    write_figures(path, {"seeds": [1, 2], "summary": {"cells": rows, "claims": {"won": ["1/gps-imu"]}}, "none": []})
    text = path.read_text(encoding="utf-8")
    assert json.loads(text) == {
        "seeds": [1, 2],
        "summary": {"cells": rounded(rows), "claims": {"won": ["1/gps-imu"]}},
        "none": [],
    }
    assert text.count('\n{"seed":') == len(rows)
    assert '\n{"seed":2,"x":0.66667},\n' in text
    assert '"claims": {"won":["1/gps-imu"]}\n' in text
