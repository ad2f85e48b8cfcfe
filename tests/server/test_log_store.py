"""Where uploaded walks lie: names that stay in their folder, a quarantine, limits, and an end."""

import os
from pathlib import Path

import pytest

from server.errors import LogRefused
from server.log_store import LogStore

DAY_S = 86_400.0


def store_in(folder: Path, *, keep_days: float = 0.0, now_s: float = 0.0, total: int = 100) -> LogStore:
    return LogStore(folder, max_bytes=60, max_total_bytes=total, keep_days=keep_days, now_s=lambda: now_s)


def add(store: LogStore, name: str, size: int = 10) -> None:
    place = store.new_place()
    place.write_bytes(bytes(size))
    store.admit(place, name)


def status(store: LogStore, name: str, size: int | None) -> int:
    with pytest.raises(LogRefused) as caught:
        store.check_place(name, size)
    return caught.value.status


def test_a_walk_is_there_once_it_was_admitted_and_only_for_its_owner(tmp_path: Path) -> None:
    store = store_in(tmp_path / "data")
    place = store.new_place()
    assert list(store) == []
    place.write_bytes(b"walk")
    store.admit(place, "a")
    assert dict(store) == {"a": tmp_path / "data" / "logs" / "a.mcap"}
    assert not place.exists()
    assert (store["a"].stat().st_mode & 0o077, (tmp_path / "data").stat().st_mode & 0o077) == (0, 0)
    store.delete("a")
    assert "a" not in store
    with pytest.raises(KeyError):
        store.delete("a")


@pytest.mark.parametrize("name", ["..", "../a", "/etc/passwd", "a/b", "", "a" * 65, "a\0", ".a", "a b", "à"])
def test_a_name_never_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    store = store_in(tmp_path / "data")
    (tmp_path / "a.mcap").write_bytes(b"outside")
    assert status(store, name, 1) == 422
    assert name not in store
    assert store.get(name) is None
    with pytest.raises(ValueError, match="no name"):
        store.admit(store.new_place(), name)


def test_what_is_too_large_too_much_or_there_already_is_refused(tmp_path: Path) -> None:
    store = store_in(tmp_path)
    store.check_place("a", 60)
    assert status(store, "a", 61) == 413
    add(store, "a", 60)
    assert status(store, "a", 1) == 409
    store.check_place("b", 40)
    assert status(store, "b", 41) == 507
    assert status(store, "b", 10**18) == 413


def test_two_uploads_of_one_name_do_not_overwrite_each_other(tmp_path: Path) -> None:
    store = store_in(tmp_path)
    first, second = store.new_place(), store.new_place()
    first.write_bytes(b"first")
    store.admit(first, "a")
    with pytest.raises(LogRefused) as caught:
        store.admit(second, "a")
    assert caught.value.status == 409
    assert store["a"].read_bytes() == b"first"


def test_the_quarantine_of_an_earlier_run_is_emptied(tmp_path: Path) -> None:
    store_in(tmp_path).new_place()
    assert len(list((tmp_path / "quarantine").iterdir())) == 1
    store_in(tmp_path)
    assert list((tmp_path / "quarantine").iterdir()) == []


def test_walks_are_kept_for_so_many_days_or_for_ever(tmp_path: Path) -> None:
    store = store_in(tmp_path, keep_days=2.0, now_s=10.0 * DAY_S)
    for name, day in (("old", 7.9), ("new", 8.1)):
        add(store, name)
        os.utime(store[name], (day * DAY_S, day * DAY_S))
    assert store_in(tmp_path, now_s=1e6 * DAY_S).expire() == []
    assert store.expire() == ["old"]
    assert list(store) == ["new"]
