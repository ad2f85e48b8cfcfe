"""Processes of ours that are confined, from outside: begun, told what to do, heard line by line, and ended."""

import asyncio
import subprocess
from contextlib import suppress
from typing import Final, TypeVar

import msgspec

from server.confinement import command, environment

T = TypeVar("T")
Process = subprocess.Popen[bytes]
_LONGEST_LINE: Final = 64 * 1024
_FAREWELL_S: Final = 3.0


def begin(module: str, *arguments: str) -> Process:
    """Begin one of our modules, with our environment's secrets left out, and nothing to write to but its standard output."""
    return subprocess.Popen(
        command(module, *arguments),
        env=environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )


async def ask(process: Process, job: msgspec.Struct, kind: type[T], seconds: float) -> T | None:
    """Tell a process its job, as a line of JSON, and return its answer, another; None where it says anything else, or nothing.

    Raises:
        TimeoutError: It takes longer. It is killed then, and wherever nobody waits for the answer any more.
    """
    try:
        return await asyncio.wait_for(asyncio.to_thread(_ask, process, job, kind), seconds)
    except BaseException:
        process.kill()
        raise


def _ask(process: Process, job: msgspec.Struct, kind: type[T]) -> T | None:
    assert process.stdin is not None
    with suppress(BrokenPipeError):
        process.stdin.write(msgspec.json.encode(job) + b"\n")
        process.stdin.flush()
    return hear(process, kind)


def hear(process: Process, kind: type[T]) -> T | None:
    """Wait for the next line of a process, and return what it says; None where it is nothing of that kind."""
    assert process.stdout is not None
    try:
        return msgspec.json.decode(process.stdout.readline(_LONGEST_LINE), type=kind)
    except msgspec.DecodeError:
        return None


def end(process: Process) -> None:
    """Kill a process: it holds nothing that would want to be saved."""
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            with suppress(OSError):
                pipe.close()
    process.kill()
    process.wait(_FAREWELL_S)
