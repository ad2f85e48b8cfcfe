"""The doctor's page for people, and the same as JSON for programs. Pure: verdicts in, text out."""

from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from server.doctor.verdict import State, Verdict, all_is_well

_MARKS: Mapping[State, tuple[str, str]] = {
    State.WELL: ("✓", "green"),
    State.ADVICE: ("!", "yellow"),
    State.AMISS: ("✗", "bold red"),
    State.ABSENT: ("–", "dim"),
}
#: Wide enough for the longest name, so that sentences stand below each other.
_NAMES = 15


def as_json(verdicts: Sequence[Verdict], asked: Mapping[str, str]) -> dict[str, Any]:
    """Return all verdicts with their figures; `asked` are the sensors' specifications by option."""
    return {
        "ok": all_is_well(verdicts),
        "asked": dict(asked),
        "checks": [verdict.as_json() for verdict in verdicts],
    }


def page(verdicts: Sequence[Verdict], command: str) -> RenderableType:
    """Return the page; `command` is the walk that was asked for."""
    parts: list[RenderableType] = []
    for group, members in groupby(verdicts, lambda verdict: verdict.group):
        parts += [Text(group, style="bold"), _table(list(members)), Text()]
    return Group(*parts, _end(verdicts, command))


def _table(verdicts: Sequence[Verdict]) -> Table:
    table = Table(box=None, padding=(0, 1, 0, 0), show_header=False)
    table.add_column(width=2, justify="right")
    table.add_column(min_width=_NAMES, no_wrap=True)
    table.add_column(overflow="fold")
    for verdict in verdicts:
        mark, style = _MARKS[verdict.state]
        told = "dim" if verdict.state is State.ABSENT else ""
        table.add_row(
            Text(mark, style),
            Text(f"  {verdict.part}" if verdict.part else verdict.name, told),
            Text(verdict.sentence, told),
        )
    return table


def _end(verdicts: Sequence[Verdict], command: str) -> Text:
    amiss = sum(verdict.state is State.AMISS for verdict in verdicts)
    advice = sum(verdict.state is State.ADVICE for verdict in verdicts)
    wishes = "" if not advice else f" {advice} {'thing' if advice == 1 else 'things'} would make it better (!)."
    if amiss:
        things = "1 thing is" if amiss == 1 else f"{amiss} things are"
        return Text(f"{things} amiss (✗): mend that and look again.{wishes}", "bold red")
    return Text(f"All that was asked for is well.{wishes} Go: {command}", "bold green")
