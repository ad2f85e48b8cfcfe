"""The path's pieces and their colours."""

import json
from pathlib import Path

import numpy as np

from server.console.path import MOTION_COLOURS, ColouredPath, colour_of

GOLDEN = Path(__file__).parents[2] / "golden" / "motion_colours.json"


def test_motion_models_have_the_pages_colours() -> None:
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    told = {model: f"#{bytes(colour_of(model)).hex()}" for model in (*MOTION_COLOURS, "-")}
    assert told == golden["models"] | {"-": golden["none"]}


def test_the_path_is_coloured_by_motion_model_and_broken_by_jumps() -> None:
    path = ColouredPath()
    points = [(0.0, "P0R0"), (0.01, "P0R0"), (1.0, "P1R1"), (2.0, "P2R2"), (200.0, "P2R2"), (201.0, "-")]
    grew = [path.add(np.array([x, 0.0, 0.0]), model) for x, model in points]
    assert grew == [False, False, True, True, False, True]
    colours = [colour for _, colour in path.pieces[0]]
    assert colours[:2] == [MOTION_COLOURS["P1R1"], MOTION_COLOURS["P2R2"]]
    assert colours[2] not in MOTION_COLOURS.values()


def test_a_lifted_path_goes_on_elsewhere() -> None:
    path = ColouredPath()
    path.add(np.zeros(3), "P1R1")
    path.lift()
    assert not path.add(np.array([1.0, 0.0, 0.0]), "P1R1")
    assert path.add(np.array([2.0, 0.0, 0.0]), "P1R1")


def test_a_long_path_grows_by_short_pieces() -> None:
    path = ColouredPath()
    for i in range(251):
        path.add(np.array([float(i), 0.0, 0.0]), "P1R1")
    assert [len(piece) for piece in path.pieces] == [100, 100, 50]


def test_what_is_no_longer_drawn_of_a_path_is_not_kept() -> None:
    """A day's walk would be a hundred megabytes of it."""
    path = ColouredPath()
    for i in range(30_000):
        path.add(np.array([0.2 * i, 0.0, 0.0]), "P0R0")
    assert len(path.pieces) == 300
    assert sum(len(piece) for piece in path.pieces) <= 200 * 100
    assert len(path.pieces[-200]) == 100
