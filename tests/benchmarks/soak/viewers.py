"""An hour of replayed walking with viewers that come and go: `agora serve` watched from outside.

Twenty places, each taken by a viewer for some seconds and then by another: half of them see the pictures, and half of them leave
without a goodbye. When the last has left, the server has to be as it was before the first came.
"""

import asyncio
import json
import os
import subprocess
import sys
from collections.abc import AsyncIterator, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any, Final

import httpx
import numpy as np
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from server.secret_file import secret_of
from server.tokens import Issued, Signer
from server.wire import decode_frame, is_frame
from tests.benchmarks.soak.process import usage
from tests.benchmarks.soak.rows import Row

AGORA: Final = Path(sys.executable).with_name("agora")
PLACES: Final = 20
#: A viewer stays, and its place is empty, for so long on average, seconds.
_STAYS_S, _EMPTY_S = 6.0, 1.0
_SESSION: Final = "walk"
_EVERY_S: Final = 1.0
#: Programs that start, and the first viewers, take memory that stays, and a replay keeps what it works out until its walk is whole:
#: the first share of the time is not judged, at most so long. A run of less than five minutes is too short for the demo's walk.
_WARM_SHARE, _WARM_S = 1.0 / 3.0, 300.0
_FLAT: Final = 0.05
_PATIENCE_S: Final = 60.0


@dataclass(frozen=True)
class Sample:
    """How the server was at one time."""

    t_s: float
    server_mb: float
    replay_mb: float
    """Of the process that replays."""
    viewers: float
    tasks: float
    files: float
    came: int
    """Viewers so far."""


@contextmanager
def _serving(folder: Path) -> Iterator[tuple[str, int]]:
    """Run a server with its data in a folder; give its address and its process."""
    config = folder / "server.toml"
    folder.mkdir(parents=True, exist_ok=True)
    config.touch()
    limits = {"MAX_REQUESTS_PER_S": "1000", "MAX_BURST": "10000"}
    settings = {"CONFIG": str(config), "DATA": str(folder), "LOG_LEVEL": "warning", **limits}
    environment = os.environ | {f"AGORA_{name}": value for name, value in settings.items()} | {"OMP_NUM_THREADS": "1"}
    command = [str(AGORA), "serve", "--port", "0"]
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as serving:
        try:
            assert serving.stdout is not None
            yield serving.stdout.readline().split()[-1], serving.pid
        finally:
            serving.terminate()


def walk(log: Path, folder: Path, seconds: float, seed: int = 1) -> Iterator[Sample]:
    """Replay a log again and again for a while, and yield a sample a second: the first and the last without any viewer.

    Args:
        log: The walk.
        folder: For the server's data; emptied by nobody.
        seconds: How long viewers come and go.
        seed: Of their coming and going.
    """
    with _serving(folder) as (url, pid):
        signer = Signer(secret_of(folder))

        def bearer(role: Issued, session: str | None = None) -> dict[str, str]:
            return {"Authorization": f"Bearer {signer.issue(role, int(signer.now_s()) + 86_400, session)}"}

        with httpx.Client(base_url=url, headers=bearer("operator"), trust_env=False, timeout=_PATIENCE_S) as operator:
            operator.put(f"/api/logs/{_SESSION}", content=log.read_bytes()).raise_for_status()
            operator.post("/api/sessions", json={"log": _SESSION}).raise_for_status()
            crowd = _Crowd(url, [bearer("viewer"), bearer("rig", _SESSION)], seed)
            with asyncio.Runner() as runner:
                samples = _samples(crowd, operator, pid, seconds)
                while (sample := runner.run(_next(samples))) is not None:
                    yield sample


async def _next(samples: AsyncIterator[Sample]) -> Sample | None:
    return await anext(samples, None)


async def _samples(crowd: "_Crowd", operator: httpx.Client, pid: int, seconds: float) -> AsyncIterator[Sample]:
    before = await _sample(crowd, operator, pid)
    yield before
    crowd.begin()
    while crowd.t_s < seconds:
        await asyncio.sleep(_EVERY_S)
        yield await _sample(crowd, operator, pid)
    await crowd.end()
    deadline_s = monotonic() + _PATIENCE_S
    while True:
        last = await _sample(crowd, operator, pid)
        left = last.viewers or last.tasks > before.tasks or last.files > before.files
        if not left or monotonic() > deadline_s:
            yield last
            return
        await asyncio.sleep(_EVERY_S)


async def _sample(crowd: "_Crowd", operator: httpx.Client, pid: int) -> Sample:
    page = (await asyncio.to_thread(operator.get, "/metrics")).text
    return Sample(
        crowd.t_s,
        _value(page, "process_resident_memory_bytes") / 1e6,
        sum(usage(child).rss_mb for child in _children(pid)),
        _value(page, "agora_viewers"),
        _value(page, "agora_tasks"),
        _value(page, "process_open_fds"),
        crowd.came,
    )


class _Crowd:
    """Viewers that come and go."""

    def __init__(self, url: str, shown: Sequence[dict[str, str]], seed: int) -> None:
        self._url, self._shown, self._seed = f"{url.replace('http', 'ws', 1)}ws/view/{_SESSION}", shown, seed
        self._began_s: float | None = None
        self._places: list[asyncio.Task[None]] = []
        self.came = 0

    @property
    def t_s(self) -> float:
        """For how long they have been coming."""
        return 0.0 if self._began_s is None else monotonic() - self._began_s

    def begin(self) -> None:
        """Have the first of them come."""
        self._began_s = monotonic()
        self._places = [asyncio.create_task(self._place(i)) for i in range(PLACES)]

    async def end(self) -> None:
        """Have the last of them leave."""
        for place in self._places:
            place.cancel()
        await asyncio.gather(*self._places, return_exceptions=True)

    async def _place(self, number: int) -> None:
        rng = np.random.default_rng((self._seed, number))
        while True:
            await asyncio.sleep(rng.exponential(_EMPTY_S))
            shown = self._shown[int(rng.integers(len(self._shown)))]
            with suppress(WebSocketException, OSError):
                async with connect(self._url, additional_headers=shown, compression=None, proxy=None) as viewer:
                    self.came += 1
                    with suppress(TimeoutError):
                        await asyncio.wait_for(_watch(viewer), rng.exponential(_STAYS_S))
                    if rng.random() < 0.5:
                        viewer.transport.abort()


async def _watch(viewer: ClientConnection) -> None:
    async for message in viewer:
        if isinstance(message, bytes) and is_frame(message):
            await viewer.send(json.dumps({"type": "ack", "frame_id": decode_frame(message)[0].frame_id}))


def rows(samples: Sequence[Sample]) -> list[Row]:
    """Return the figures; the first and the last sample have no viewers."""
    before, *during, after = samples
    warm_s = min(_WARM_S, _WARM_SHARE * during[-1].t_s)
    settled = [sample for sample in during if sample.t_s >= warm_s]
    return [
        Row("the server's memory, last tenth over first", growth(settled, "server_mb"), "%", most=100.0 * _FLAT),
        Row("the replay's memory, last tenth over first", growth(settled, "replay_mb"), "%", most=100.0 * _FLAT),
        Row("tasks left when all had gone", after.tasks - before.tasks, "", most=0),
        Row("files left open when all had gone", after.files - before.files, "", most=0),
        Row("viewers that came and went", after.came, ""),
        Row("viewers at a time, mean", float(np.mean([sample.viewers for sample in settled])), ""),
        Row("the server's memory at the end", after.server_mb, "MB"),
        Row("the replay's memory at the end", after.replay_mb, "MB"),
    ]


def growth(samples: Sequence[Sample], name: str) -> float:
    """Return by how much the mean of the last tenth is more than that of the first, per cent."""
    values = [getattr(sample, name) for sample in samples]
    tenth = max(1, len(values) // 10)
    first = float(np.mean(values[:tenth]))
    return 100.0 * (float(np.mean(values[-tenth:])) - first) / first


def _children(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    found = [path.read_text(encoding="ascii").split() for path in Path(f"/proc/{pid}/task").glob("*/children")]
    return [int(child) for children in found for child in children]


def _value(page: str, name: str) -> float:
    lines: list[Any] = [line for line in page.splitlines() if line.split("{")[0].split(" ")[0] == name]
    return sum(float(line.rsplit(" ", 1)[1]) for line in lines)
