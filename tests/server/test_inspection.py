"""The first reading of an uploaded file, by a process with limits."""

import json
import subprocess
from pathlib import Path

import pytest

from server.confinement import command, environment
from server.errors import LogRefused
from server.inspection import inspect
from tests.server.uploads import bomb, with_chunk
from tests.walks import write_walk


def test_a_walk_is_told_by_what_it_holds(tmp_path: Path) -> None:
    holds = inspect(write_walk(tmp_path / "walk.mcap", 3.0))
    assert holds["duration_s"] == pytest.approx(3.0, abs=0.5)
    assert holds["counts"]["imu"] > 300
    assert holds["truncated"] is False


def test_a_bomb_and_a_file_without_measurements_are_refused(tmp_path: Path) -> None:
    with pytest.raises(LogRefused) as bombed:
        inspect(with_chunk(tmp_path / "a.mcap", bomb(50 * 10**9), 50 * 10**9))
    assert bombed.value.status == 413
    with pytest.raises(LogRefused, match="holds no IMU and no GPS") as empty:
        inspect(with_chunk(tmp_path / "b.mcap", b"", 0, ""))
    assert empty.value.status == 422
    assert str(tmp_path) not in str(empty.value)


def test_a_reading_that_takes_too_much_is_ended_and_refused(tmp_path: Path) -> None:
    walk = write_walk(tmp_path / "walk.mcap", 3.0)
    with pytest.raises(LogRefused) as slow:
        inspect(walk, cpu_s=0)
    with pytest.raises(LogRefused) as large:
        inspect(walk, memory_bytes=60 * 10**6)
    assert (slow.value.status, large.value.status) == (422, 422)


def test_a_confined_process_writes_no_file_and_knows_no_secret(tmp_path: Path) -> None:
    script = tmp_path / "tries.py"
    script.write_text(
        "import json, os, sys\n"
        "from server.confinement import confine\n"
        "confine(10**9, 60)\n"
        "out = {'known': sorted(n for n in os.environ if n.startswith('AGORA'))}\n"
        "try:\n    open(sys.argv[1], 'wb', buffering=0).write(bytes(9)); out['wrote'] = True\n"
        "except OSError: out['wrote'] = False\n"
        "try:\n    bytearray(2 * 10**9); out['took'] = True\n"
        "except MemoryError: out['took'] = False\n"
        "print(json.dumps(out))\n"
    )
    surroundings = environment(
        {"AGORA_TOKEN": "secret", "PATH": "/bin", "PYTHONPATH": environment().get("PYTHONPATH", "")}
    )
    asked = [command("x")[0], str(script), str(tmp_path / "written")]
    done = subprocess.run(asked, env=surroundings, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == {"known": [], "wrote": False, "took": False}
