"""The walks that were uploaded: one folder, and beside it a quarantine for those that nobody has read yet. Files, no requests."""

import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Final
from uuid import uuid4

from server.errors import LogRefused
from server.grants import SESSION_PATTERN
from server.sessions import NAME

_DAY_S: Final = 86_400.0
#: The disk is never filled further than to this.
_LEAVE_FREE: Final = 200 * 10**6


class LogStore(Mapping[str, Path]):
    """Names to files. Methods may be called from any thread: every change is one operation on the file system."""

    def __init__(
        self, folder: Path, *, max_bytes: int, max_total_bytes: int, keep_days: float, now_s: Callable[[], float]
    ) -> None:
        """Make the folders, readable by their owner only; what an earlier run left in quarantine is deleted.

        Args:
            folder: Where `logs` and `quarantine` are.
            max_bytes: Of one walk.
            max_total_bytes: Of all.
            keep_days: How long a walk is kept; 0 for ever.
            now_s: Seconds since 1970, as the files' times are.
        """
        self._logs, self._quarantine = folder / "logs", folder / "quarantine"
        self.max_bytes, self._max_total, self._keep_days, self._now_s = max_bytes, max_total_bytes, keep_days, now_s
        for place in (folder, self._logs, self._quarantine):
            place.mkdir(mode=0o700, parents=True, exist_ok=True)
        for left in self._quarantine.iterdir():
            left.unlink(missing_ok=True)

    def __getitem__(self, name: str) -> Path:
        path = self._path(name)
        if path is None or not path.is_file():
            raise KeyError(name)
        return path

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(path.stem for path in self._logs.glob("*.mcap") if NAME.fullmatch(path.stem)))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def check_place(self, name: str, size: int | None) -> None:
        """Return where a walk of this name and size, if that is known, may come.

        Raises:
            LogRefused: With the status that says why not.
        """
        if self._path(name) is None:
            raise LogRefused(
                422, f"A walk's name is 1 to 64 letters, digits, dots, dashes or underscores ({SESSION_PATTERN})."
            )
        if name in self:
            raise LogRefused(409, f"There is a walk {name!r} already: delete it first, or choose another name.")
        if size is not None and size > self.max_bytes:
            raise LogRefused(413, f"A walk may have {self.max_bytes} bytes at most, this one has {size}.")
        needed = size or 0
        if sum(path.stat().st_size for path in self._logs.iterdir()) + needed > self._max_total:
            raise LogRefused(507, "The server keeps as many walks as it may: delete some first.")
        if shutil.disk_usage(self._logs).free < needed + _LEAVE_FREE:
            raise LogRefused(507, "The server's disk is full: delete some walks first.")

    def new_place(self) -> Path:
        """Return a fresh file in quarantine."""
        path = self._quarantine / f"{uuid4().hex}.part"
        os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600))
        return path

    def admit(self, place: Path, name: str) -> None:
        """Give a file in quarantine its name: it is a walk now.

        Raises:
            LogRefused: 409, the name was taken meanwhile.
        """
        target = self._path(name)
        if target is None:
            raise ValueError(f"no name of a walk: {name!r}")
        try:
            os.link(place, target)  # unlike a renaming, never over another
        except FileExistsError as exc:
            raise LogRefused(409, f"There is a walk {name!r} already: choose another name.") from exc
        place.unlink()

    def discard(self, place: Path) -> None:
        """Delete a file in quarantine."""
        place.unlink(missing_ok=True)

    def delete(self, name: str) -> None:
        """Delete a walk; `KeyError` where there is none."""
        self[name].unlink(missing_ok=True)

    def expire(self) -> list[str]:
        """Delete the walks that are kept no longer, and return their names."""
        gone: list[str] = []
        for name in list(self) if self._keep_days else []:
            with suppress(KeyError, FileNotFoundError):
                if self._now_s() - self[name].stat().st_mtime > self._keep_days * _DAY_S:
                    self.delete(name)
                    gone.append(name)
        return gone

    def _path(self, name: str) -> Path | None:
        return self._logs / f"{name}.mcap" if NAME.fullmatch(name) else None
