"""Replays of uploaded walks: a session and a process each, however many of one walk. For one event loop."""

import logging
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from server.confined import Process, ask, begin, end, hear
from server.errors import ReplayRefused, ServerFull
from server.log_store import LogStore
from server.replay_process import Answer, ReplayJob
from server.sessions import ENDED, NAME, Sessions

_logger = logging.getLogger(__name__)

#: From its start to its answer: Python's libraries, the site's ground, one reading of the walk.
_START_S: Final = 120.0
_FAILED: Final = Answer("Replaying this walk failed.")


@dataclass
class _Running:
    log: str
    process: Process
    t_watched_ns: int


class Replays:
    """All that are running. A replay ends when it is told to, when nobody watches it any more, or when its process does."""

    def __init__(
        self,
        sessions: Sessions,
        store: LogStore,
        *,
        site: Path,
        link: Callable[[str], tuple[str, str]],
        most: int,
        idle_s: float,
        memory_bytes: int,
        trust: str | None = None,
    ) -> None:
        """Nothing runs yet.

        Args:
            sessions: Of this server.
            store: Where the walks are.
            site: Its folder.
            link: Returns a session's address for a rig, and a token for it.
            most: Replays at a time.
            idle_s: How long one goes on without a viewer.
            memory_bytes: Of each process.
            trust: The certificate that this server shows, where it has one.
        """
        self._sessions, self._store, self._site, self._link = sessions, store, site, link
        self._most, self._idle_ns, self._memory_bytes = most, int(idle_s * 1e9), memory_bytes
        self._trust = trust
        self._running: dict[str, _Running] = {}
        self._starting = 0

    async def start(
        self, log: str, *, estimator: str | None = None, anchor: Literal["site", "here"] = "site", looping: bool = True
    ) -> str:
        """Start a replay and return its session's name, once it plays.

        Raises:
            KeyError: There is no walk of that name.
            ReplayRefused: The walk cannot be played, or not with that estimator.
            ServerFull: As many are running as may.
        """
        path = self._store[log]
        if len(self._running) + self._starting >= self._most:
            raise ServerFull(f"{self._most} walks are being replayed already: end one of them first.")
        name = self._free_name(log)
        self._sessions.open(name).expect({"kind": "replay", "log": log, "estimator": estimator or ""})
        url, token = self._link(name)
        job = ReplayJob(
            log=str(path),
            site=str(self._site),
            estimator=estimator,
            anchor=anchor,
            looping=looping,
            url=url,
            token=token,
            trust=self._trust,
        )
        self._starting += 1
        try:
            process = await self._launch(job)
        except ReplayRefused as exc:
            self._end_session(name, str(exc))
            raise
        finally:
            self._starting -= 1
        self._running[name] = _Running(log, process, self._sessions.now_ns())
        _logger.info("a replay began", extra={"session": name, "log": log, "estimator": estimator})
        return name

    def log_of(self, name: str) -> Path | None:
        """Return the walk that a replay plays; None where there is no such replay, or the walk has gone."""
        running = self._running.get(name)
        return None if running is None else self._store.get(running.log)

    def stop(self, name: str, reason: str) -> None:
        """End a replay and its session; nothing happens where there is none of that name."""
        running = self._running.pop(name, None)
        if running is None:
            return
        end(running.process)
        self._end_session(name, reason)
        _logger.info("a replay ended", extra={"session": name, "log": running.log, "why": reason})

    def stop_all_of(self, log: str, reason: str) -> None:
        """End every replay of a walk."""
        for name in [name for name, running in self._running.items() if running.log == log]:
            self.stop(name, reason)

    def look_after(self) -> None:
        """End those whose process has ended and those that nobody has watched for too long. To be called every second."""
        now_ns = self._sessions.now_ns()
        for name, running in list(self._running.items()):
            if running.process.poll() is not None:
                self.stop(name, _last_words(running.process))
            elif name not in self._sessions:
                self.stop(name, "This walk has ended.")
            elif self._sessions.get(name).viewers:
                running.t_watched_ns = now_ns
            elif now_ns - running.t_watched_ns > self._idle_ns:
                self.stop(name, "Nobody watched this walk any more.")

    def close(self) -> None:
        """End all processes."""
        for running in self._running.values():
            end(running.process)
        self._running.clear()

    # -----------------------------------------------------------------------------------------------------------------

    async def _launch(self, job: ReplayJob) -> Process:
        process = begin("server.replay_process", str(self._memory_bytes))
        try:
            answer = await ask(process, job, Answer, _START_S) or _FAILED
        except TimeoutError as exc:
            raise ReplayRefused("The walk took too long to begin.") from exc
        if answer.error is not None:
            end(process)
            raise ReplayRefused(answer.error)
        return process

    def _free_name(self, log: str) -> str:
        for number in range(1, 10_000):
            name = log if number == 1 else f"{log[:58]}-{number}"
            if name not in self._sessions and NAME.fullmatch(name):
                return name
        raise ServerFull("Too many walks of that name: end some first.")

    def _end_session(self, name: str, reason: str) -> None:
        if name in self._sessions:
            self._sessions.end(name, ENDED, reason)


def _last_words(process: Process) -> str:
    answer = hear(process, Answer)
    return (answer and answer.error) or "The replay has ended."
