"""Processes that read what strangers have sent: little memory, little time, no files to write, and none of our secrets."""

import os
import resource
import sys
from collections.abc import Mapping
from typing import Final

import msgspec

#: What a child is told of our environment; nothing of `AGORA_…`.
_PASSED_ON: Final = ("PATH", "HOME", "LANG", "LC_ALL", "TMPDIR", "PYTHONPATH", "VIRTUAL_ENV")
_OPEN_FILES: Final = 256


def confine(memory_bytes: int, cpu_s: int | None = None) -> None:
    """Limit the process that calls, for good.

    Args:
        memory_bytes: Of address space, threads' stacks and libraries included.
        cpu_s: Of processor time, after which the kernel ends it; None for no limit.
    """
    wanted = {
        resource.RLIMIT_AS: memory_bytes,
        resource.RLIMIT_CORE: 0,
        resource.RLIMIT_FSIZE: 0,
        resource.RLIMIT_NOFILE: _OPEN_FILES,
    }
    if cpu_s is not None:
        wanted[resource.RLIMIT_CPU] = cpu_s
    for kind, limit in wanted.items():
        hard = resource.getrlimit(kind)[1]
        least = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(kind, (least, least))


def tell(answer: msgspec.Struct) -> None:
    """Say something to whoever began this process, in a line of JSON."""
    sys.stdout.write(msgspec.json.encode(answer).decode() + "\n")
    sys.stdout.flush()


def command(module: str, *arguments: str) -> list[str]:
    """Return the command that runs one of our modules; the folder that we are in has no say in what it imports."""
    return [sys.executable, "-P", "-m", module, *arguments]


def environment(ours: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Return what such a process knows of our environment."""
    # a thread for each core, each with a stack of its own, would be counted as memory
    return {name: ours[name] for name in _PASSED_ON if name in ours} | {
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MALLOC_ARENA_MAX": "2",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
