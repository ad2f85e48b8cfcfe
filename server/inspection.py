"""An uploaded file opened for the first time, in a process of its own: is it a walk, and what does it hold?

    python -m server.inspection FILE MEMORY_BYTES CPU_S

prints one line of JSON: what the walk holds, or `status` and `error`.
"""

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

from server.confinement import command, confine, environment
from server.errors import LogRefused

MEMORY_BYTES: Final = 2 * 10**9
CPU_S: Final = 120
#: Beside the processor's time: a disk that hangs.
_WALL_S: Final = 300.0
_LONGEST_ANSWER: Final = 64 * 1024


def inspect(path: Path, memory_bytes: int = MEMORY_BYTES, cpu_s: int = CPU_S) -> dict[str, Any]:
    """Return what a file holds (`duration_s`, `counts`, `truncated`); this process does not read it.

    Raises:
        LogRefused: It is no walk, or reading it takes more memory or time than any walk does.
    """
    asked = command("server.inspection", str(path), str(memory_bytes), str(cpu_s))
    try:
        done = subprocess.run(
            asked, env=environment(), stdin=subprocess.DEVNULL, capture_output=True, timeout=_WALL_S, check=False
        )
    except subprocess.TimeoutExpired as exc:
        raise LogRefused(422, f"Reading this file took longer than {_WALL_S:.0f} s.") from exc
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        raise LogRefused(422, f"Reading this file took more than {cpu_s} s of processor time, or too much memory.")
    try:
        answer = json.loads(done.stdout[:_LONGEST_ANSWER])
    except ValueError as exc:
        raise LogRefused(422, "Reading this file failed: it is no walk, or a damaged one.") from exc
    if "error" in answer:
        raise LogRefused(int(answer["status"]), str(answer["error"]))
    return dict(answer)


def _look(path: Path) -> dict[str, Any]:
    from server.chunks import check_chunks  # after the limits are set
    from tracker.errors import InputError
    from tracker.log import Log

    try:
        check_chunks(path)
        info = Log.open(path).info
    except LogRefused as exc:
        return {"status": exc.status, "error": str(exc)}
    except InputError as exc:
        return {"status": 422, "error": str(exc).replace(str(path), "The file")}
    except MemoryError:
        return {"status": 413, "error": "Reading this file takes more memory than any walk does."}
    return {"duration_s": info.duration_s, "counts": dict(info.counts), "truncated": info.truncated}


if __name__ == "__main__":
    confine(int(sys.argv[2]), int(sys.argv[3]))
    sys.stdout.write(json.dumps(_look(Path(sys.argv[1]))))
