"""Mailboxes: what may not be lost is not, what is old is replaced, and nobody waits who puts something in."""

from threading import Thread

from tracker.measurements import Frame, ImuSample
from tracker.pictures import EncodedPicture
from tracker.running.mail import Intake, Look, Slot


def _imu(index: int) -> ImuSample:
    return ImuSample(index, index, (0.0, 0.0, 0.0), (0.0, 0.0, 9.81))


def _frame(index: int) -> Frame:
    return Frame(index, index, index, EncodedPicture(b""))


def test_many_threads_lose_nothing_and_each_keeps_its_order() -> None:
    """Four sensors at once, taken in batches meanwhile."""
    intake, taken = Intake(), list[tuple[str, int]]()

    def say(name: str) -> None:
        for index in range(1000):
            intake.put(name, _imu(index))

    threads = [Thread(target=say, args=(f"s{number}",)) for number in range(4)]
    for thread in threads:
        thread.start()
    while len(taken) < 4000:
        intake.wait(1.0)
        taken += [(name, m.t_ns) for name, m in intake.take().measurements]
    for number in range(4):
        assert [t_ns for name, t_ns in taken if name == f"s{number}"] == list(range(1000))
    assert not intake.lost


def test_an_overflow_is_counted_and_keeps_what_came_first() -> None:
    """Twenty seconds of samples wait; of pictures the newest four."""
    intake = Intake()
    for index in range(5003):
        intake.put("imu", _imu(index))
    for index in range(6):
        intake.put("camera", _frame(index))
    batch = intake.take()
    assert [m.t_ns for _, m in batch.measurements] == list(range(5000))
    assert [f.frame_id for _, f in batch.frames] == [2, 3, 4, 5]
    assert intake.lost == {"imu": 3, "camera": 2}


def test_looks_arrive_in_order() -> None:
    """What vision made of pictures waits beside the rest."""
    intake = Intake()
    for index in range(3):
        intake.put_look(Look(_frame(index), None, False))
    assert [look.frame.frame_id for look in intake.take().looks] == [0, 1, 2]
    assert intake.take().looks == []


def test_the_newest_wins_a_slot() -> None:
    """What it replaced is counted; a closed slot lets nobody wait."""
    slot: Slot[int] = Slot()
    assert slot.take(0.0) is None
    slot.put(1)
    slot.put(2)
    assert (slot.take(), slot.replaced) == (2, 1)
    slot.close()
    slot.put(3)
    assert slot.take() is None
    assert slot.closed
