"""The console: the path's pieces, that viser starts and stops, and that importing us does not import it."""

import subprocess
import sys
import threading
import warnings

import numpy as np

from server.console import MOTION_COLOURS, ColouredPath, Console
from tests.server.serving import until
from tests.server.wire_examples import example_frame


def test_the_path_is_coloured_by_motion_model_and_broken_by_jumps() -> None:
    path = ColouredPath()
    points = [(0.0, "P0R0"), (0.01, "P0R0"), (1.0, "P1R1"), (2.0, "P2R2"), (200.0, "P2R2"), (201.0, "-")]
    grew = [path.add(np.array([x, 0.0, 0.0]), model) for x, model in points]
    assert grew == [False, False, True, True, False, True]
    colours = [colour for _, colour in path.pieces[0]]
    assert colours[:2] == [MOTION_COLOURS["P1R1"], MOTION_COLOURS["P2R2"]]
    assert colours[2] not in MOTION_COLOURS.values()


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


def test_the_console_starts_draws_and_leaves_no_thread() -> None:
    before = set(threading.enumerate())
    frame = example_frame()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # viser's own imports
        console = Console(0)
        assert console.start().startswith("http://127.0.0.1:")
        for x in (0.0, 1.0, 2.0):
            T_site_cam = frame.T_site_cam.copy()
            T_site_cam[0, 3] = x
            console.show(T_site_cam, frame.camera, frame.motion_model)
        console.clear()
        console.stop()
        console.stop()
    until(lambda: set(threading.enumerate()) <= before)


def test_viser_is_not_imported_at_start_up() -> None:
    code = "import sys, server.console, server.app, server.push; sys.exit('viser' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
