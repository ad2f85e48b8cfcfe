"""Tasks over processes: kept results are not made again, a failure spoils no other, another key is another result."""

from pathlib import Path

import pytest

from server.paper.tasks import Task, TasksFailed, content_key, run_tasks


def note(folder: str, number: int) -> dict[str, int]:
    """A task: leaves a line, so that a test can count how often it ran, and fails for seven."""
    with (Path(folder) / "ran.txt").open("a", encoding="ascii") as file:
        file.write(f"{number}\n")
    if number == 7:
        raise ValueError("seven is not done")
    return {"square": number * number}


def _tasks(folder: Path, numbers: list[int]) -> list[Task]:
    return [Task(f"task-{n}", note, (str(folder), n)) for n in numbers]


def _ran(folder: Path) -> list[str]:
    return (folder / "ran.txt").read_text(encoding="ascii").split()


def test_results_come_in_order_and_are_kept(tmp_path: Path) -> None:
    """The second time nothing runs; a new task runs alone."""
    tasks, told = _tasks(tmp_path, [3, 1, 2]), []
    first = run_tasks(tasks, key="a", jobs=1, folder=tmp_path, done=lambda done, total: told.append((done, total)))
    assert first == [{"square": 9}, {"square": 1}, {"square": 4}]
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]
    assert run_tasks(tasks, key="a", jobs=1, folder=tmp_path) == first
    run_tasks(_tasks(tmp_path, [1, 5]), key="a", jobs=1, folder=tmp_path)
    assert _ran(tmp_path) == ["3", "1", "2", "5"]


def test_another_key_is_another_result(tmp_path: Path) -> None:
    """What was made by other sources is made again."""
    for key in ("a", "b", "a"):
        run_tasks(_tasks(tmp_path, [1]), key=key, jobs=1, folder=tmp_path)
    assert _ran(tmp_path) == ["1", "1"]


def test_a_failure_spoils_no_other(tmp_path: Path) -> None:
    """It is named with its reason, the others are kept, and it alone is tried again."""
    with pytest.raises(TasksFailed, match=r"1 of 3 failed.*task-7: ValueError: seven is not done"):
        run_tasks(_tasks(tmp_path, [7, 1, 2]), key="a", jobs=1, folder=tmp_path)
    with pytest.raises(TasksFailed, match="1 of 3"):
        run_tasks(_tasks(tmp_path, [7, 1, 2]), key="a", jobs=1, folder=tmp_path)
    assert _ran(tmp_path) == ["7", "1", "2", "7"]


def test_processes_give_what_one_gives(tmp_path: Path) -> None:
    """Two spawned processes, one of whose tasks fails: the same results, and the same error."""
    tasks = [Task(f"power-{n}", pow, (2, n)) for n in range(4)]
    assert run_tasks(tasks, key="a", jobs=2, folder=tmp_path / "two") == [1, 2, 4, 8]
    assert run_tasks(tasks, key="a", jobs=1, folder=tmp_path / "one") == [1, 2, 4, 8]
    with pytest.raises(TasksFailed, match="1 of 3 failed, the first: broken: ZeroDivisionError"):
        run_tasks([*tasks[:2], Task("broken", divmod, (1, 0))], key="b", jobs=2, folder=tmp_path / "two")


def test_the_key_is_the_content(tmp_path: Path) -> None:
    """It follows what files hold and the values beside them, not when they were written."""
    file = tmp_path / "source.py"
    file.write_text("x = 1\n", encoding="ascii")
    before = content_key([file], 3)
    file.write_text("x = 1\n", encoding="ascii")
    assert content_key([file], 3) == before
    assert content_key([file], 4) != before
    file.write_text("x = 2\n", encoding="ascii")
    assert content_key([file], 3) != before
