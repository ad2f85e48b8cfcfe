"""A bar for whatever takes more than a second."""

from collections.abc import Iterator
from contextlib import contextmanager

from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from server.terminal import terminal


@contextmanager
def progress_bar(what: str) -> Iterator[Progress]:
    """Show how far something is on standard error, and nothing any more once it is done."""
    columns = (
        TextColumn(what),
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=terminal(stderr=True), transient=True) as bar:
        yield bar
