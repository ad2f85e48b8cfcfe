"""Many independent tasks over processes: each one's result is kept, so that what was interrupted goes on where it was."""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import cv2
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

#: What a task gives back: whatever JSON can hold.
Result = Any
FOLDER = Path("build/paper")


class TasksFailed(RuntimeError):
    """Some tasks raised; the others are done and kept."""


@dataclass(frozen=True)
class Task:
    """A piece of work: `work(*arguments)` in some process, its result kept under `name`."""

    name: str
    work: Callable[..., Result]
    arguments: tuple[Any, ...]


def content_key(files: Iterable[Path], *more: object) -> str:
    """Return a name for the content of files and some values: results that were made with others are not used."""
    content = sha256(repr(more).encode())
    for file in sorted(files):
        content.update(file.name.encode() + b"\0" + file.read_bytes())
    return content.hexdigest()[:16]


def run_tasks(
    tasks: Sequence[Task],
    *,
    key: str,
    jobs: int,
    folder: Path = FOLDER,
    done: Callable[[int, int], None] = lambda done, total: None,
) -> list[Result]:
    """Return the tasks' results in their order, run or read.

    Args:
        tasks: With different names.
        key: Of everything that a result depends on; part of its file's name.
        jobs: Processes; with one, all runs in this one.
        folder: Where results are kept.
        done: Told how many are done, and of how many.

    Raises:
        TasksFailed: A task raised an exception. The others are run first, and need not be run again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = {task.name: kept_file(folder, task.name, key) for task in tasks}
    missing = [task for task in tasks if not files[task.name].is_file()]
    finished, failed = len(tasks) - len(missing), []
    done(finished, len(tasks))
    for name, outcome in _outcomes(missing, jobs):
        try:
            _write(files[name], outcome())
        except Exception as error:
            failed.append(f"{name}: {type(error).__name__}: {error}")
        finished += 1
        done(finished, len(tasks))
    if failed:
        raise TasksFailed(f"{len(failed)} of {len(tasks)} failed, the first: {failed[0]}")
    return [json.loads(files[task.name].read_text(encoding="utf-8")) for task in tasks]


def kept_file(folder: Path, name: str, key: str) -> Path:
    """Return where a task's result is kept."""
    return folder / f"{name}-{key}.json"


def _outcomes(tasks: Sequence[Task], jobs: int) -> Iterator[tuple[str, Callable[[], Result]]]:
    if jobs <= 1 or len(tasks) <= 1:
        for task in tasks:
            yield task.name, lambda task=task: task.work(*task.arguments)  # type: ignore[misc]
        return
    # spawned, not forked: a renderer's context and OpenCV's threads do not live through a fork
    with ProcessPoolExecutor(min(jobs, len(tasks)), get_context("spawn"), _quiet_cores) as pool:
        running: dict[Future[Result], str] = {pool.submit(task.work, *task.arguments): task.name for task in tasks}
        try:
            for future in as_completed(running):
                yield running[future], future.result
        finally:
            pool.shutdown(cancel_futures=True)


def _quiet_cores() -> None:
    cv2.setNumThreads(1)


def _write(path: Path, result: Result) -> None:
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    part.write_text(json.dumps(result, allow_nan=False), encoding="utf-8")
    part.replace(path)


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """Show a bar on the error output; give what `run_tasks` tells its progress to."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task(what, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)
