"""What was asked of recorded walks, and the answers: worked out once, in a process of their own, and kept. For one event loop."""

import asyncio
import signal
import subprocess
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

import msgspec

from server.confined import begin
from server.errors import LogRefused
from server.reviewing.jobs import Job, PackJob, Refusal

#: An estimator with a camera goes five times as fast as the walk, or faster.
_CPU_S: Final = 1800
_WALL_S: Final = 3600.0
_KEPT_BYTES: Final = 64 * 10**6
#: Processes at a time: a replay must go on beside them.
_AT_A_TIME: Final = 1
_MOST_WAITING: Final = 32
#: How often who waits looks whether it should.
_LOOK_UP_S: Final = 0.5


class _Key(NamedTuple):
    """A job, of a file as it was."""

    job: Job
    t_changed_ns: int
    size: int


class Reviews:
    """Answers by job. Whoever asks for what is being worked out waits for the same process."""

    def __init__(self, memory_bytes: int, stopping: Callable[[], bool] = lambda: False) -> None:
        """`memory_bytes` is what each process may take; `stopping` says whether nobody is to wait any longer."""
        self._memory_bytes, self._stopping = memory_bytes, stopping
        self._kept: OrderedDict[_Key, bytes] = OrderedDict()
        self._under_way: dict[_Key, asyncio.Task[bytes]] = {}
        self._turn = asyncio.Semaphore(_AT_A_TIME)
        self._processes: set[subprocess.Popen[bytes]] = set()

    async def answer(self, job: Job) -> bytes:
        """Return the answer to a job.

        Raises:
            LogRefused: There is none, with the status that says why.
        """
        try:
            state = Path(job.log).stat()
        except OSError as exc:
            raise LogRefused(404, "This walk is not here any more.") from exc
        key = _Key(job, state.st_mtime_ns, state.st_size)
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        if key not in self._under_way:
            if len(self._under_way) >= _MOST_WAITING:
                raise LogRefused(503, "The server is busy with other walks: try again in a minute.")
            task = self._under_way[key] = asyncio.create_task(self._work_out(key))
            task.add_done_callback(lambda done: self._settled(key, done))
        return await self._awaited(self._under_way[key])

    def close(self) -> None:
        """End all processes."""
        for process in list(self._processes):
            process.kill()

    async def _awaited(self, task: "asyncio.Task[bytes]") -> bytes:
        while not (await asyncio.wait({task}, timeout=_LOOK_UP_S))[0]:
            if self._stopping():
                raise LogRefused(503, "The server is being stopped.")
        return task.result()

    async def _work_out(self, key: _Key) -> bytes:
        async with self._turn:
            answer = await asyncio.to_thread(self._ask, key.job)
        if not isinstance(key.job, PackJob):  # asked for once, and large
            self._kept[key] = answer
            while sum(map(len, self._kept.values())) > _KEPT_BYTES and len(self._kept) > 1:
                self._kept.popitem(last=False)
        return answer

    def _settled(self, key: _Key, done: "asyncio.Task[bytes]") -> None:
        self._under_way.pop(key, None)
        if not done.cancelled():
            done.exception()  # those who waited have it; nobody may be left who does

    def _ask(self, job: Job) -> bytes:
        process = begin("server.reviewing.process", str(self._memory_bytes), str(_CPU_S))
        self._processes.add(process)
        try:
            answer, _ = process.communicate(msgspec.json.encode(job) + b"\n", timeout=_WALL_S)
        except subprocess.TimeoutExpired as exc:
            raise LogRefused(422, "Reading this walk takes too long.") from exc
        finally:
            process.kill()
            process.wait()
            self._processes.discard(process)
        if process.returncode == 0:
            return answer
        raise _refused(process.returncode, answer)


def _refused(code: int, answer: bytes) -> LogRefused:
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return LogRefused(422, "Reading this walk takes more time or memory than it may.")
    try:
        refusal = msgspec.json.decode(answer, type=Refusal)
    except msgspec.DecodeError:
        return LogRefused(422, "Reading this walk failed.")
    return LogRefused(refusal.status, refusal.error)
