"""What a run has measured so far, line by line on the disk: a run that was interrupted is known by its missing end."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from fcntl import LOCK_EX, LOCK_NB, flock
from pathlib import Path
from typing import Any

_END = {"end": True}


class Journal:
    """One run's file, written as it goes."""

    def __init__(self, folder: Path, kind: str, about: Mapping[str, Any]) -> None:
        """Begin; `about` says what is run, where and on what."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{kind}-{datetime.now(UTC):%Y%m%d-%H%M%S}.jsonl"
        self._file = path.open("a", encoding="utf-8")
        flock(self._file, LOCK_EX | LOCK_NB)  # as long as it is open, the run goes on
        self.add({"kind": kind, **about})

    def add(self, line: Mapping[str, Any]) -> None:
        """Write a line, at once."""
        self._file.write(json.dumps(dict(line)) + "\n")
        self._file.flush()

    def end(self) -> None:
        """Note that the run is whole."""
        self.add(_END)
        self.close()

    def close(self) -> None:
        """Leave it, whole or not."""
        self._file.close()


@dataclass(frozen=True)
class Interrupted:
    """A run that has no end."""

    about: dict[str, Any]
    lines: int
    """How much it had measured."""


def interrupted(folder: Path) -> Iterator[Interrupted]:
    """Yield the runs that were interrupted since somebody asked last."""
    for path in sorted(folder.glob("*.jsonl")):
        if _goes_on(path):
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        whole = [line for line in lines if line.endswith("}")]  # the last may be cut off
        if whole and json.loads(whole[-1]) == _END:
            continue
        if whole:
            yield Interrupted(json.loads(whole[0]), len(whole) - 1)
        path.rename(path.with_suffix(".interrupted"))


def _goes_on(path: Path) -> bool:
    with path.open("a", encoding="utf-8") as file:
        try:
            flock(file, LOCK_EX | LOCK_NB)
        except BlockingIOError:
            return True
    return False


class Session:
    """Which parts of one `make soak` are done: what was interrupted goes on with the part that was."""

    def __init__(self, folder: Path, parts: tuple[str, ...], commit: str) -> None:
        self._file, self._parts, self._commit = folder / "session.json", parts, commit

    @property
    def left(self) -> tuple[str, ...]:
        """The parts to run."""
        known = json.loads(self._file.read_text(encoding="utf-8")) if self._file.exists() else {}
        done = known.get("done", []) if known.get("commit") == self._commit else []
        return tuple(part for part in self._parts if part not in done)

    def finish(self, part: str) -> None:
        """Note a part; with the last one the session is over."""
        left = [each for each in self.left if each != part]
        if not left:
            self._file.unlink(missing_ok=True)
            return
        self._file.parent.mkdir(parents=True, exist_ok=True)
        done = [each for each in self._parts if each not in left]
        self._file.write_text(json.dumps({"commit": self._commit, "done": done}), encoding="utf-8")
