"""`python -m server.paper`: which steps run, in what order, with how many seeds."""

from collections.abc import Callable

import pytest

from server.paper import __main__ as command


@pytest.fixture
def ran(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, int | None, int]]:
    """What would have been run."""
    steps: list[tuple[str, int | None, int]] = []

    def step(name: str, seeds: int | None, jobs: int) -> Callable[[], None]:
        return lambda: steps.append((name, seeds, jobs))

    monkeypatch.setattr(command, "_step", step)
    return steps


def test_all_steps_in_order(ran: list[tuple[str, int | None, int]]) -> None:
    """The document comes last: it reads what the others write."""
    command.main(["--jobs", "3"])
    assert ran == [(name, None, 3) for name in ("study", "sweep", "attitude", "readings", "ablation", "document")]


def test_one_step_with_few_seeds(ran: list[tuple[str, int | None, int]]) -> None:
    """As asked for."""
    command.main(["--only", "sweep", "--seeds", "2", "--jobs", "1"])
    assert ran == [("sweep", 2, 1)]


def test_a_step_that_there_is_not_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    """With those that there are."""
    with pytest.raises(SystemExit):
        command.main(["--only", "everything"])
    assert "study" in capsys.readouterr().err


def test_every_step_can_be_made() -> None:
    """Its name leads to something to run."""
    assert all(callable(command._step(name, None, 1)) for name in command.STEPS)
