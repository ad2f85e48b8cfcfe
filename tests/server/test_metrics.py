"""`/metrics` as a Prometheus reader takes it: what came, what went, what was dropped, how long it took."""

from pathlib import Path
from time import monotonic_ns

import pytest
from prometheus_client.parser import text_string_to_metric_families
from websockets.exceptions import InvalidStatus

from server.cluster.bus import LocalBus
from server.cluster.relay import Relay
from server.fanout import Mailbox
from server.metrics import Metrics
from server.sessions import Sessions
from server.traffic import BOUNDS_S, Durations
from server.wire import encode_frame, encode_pose
from tests.server.lines import Wire, at_once
from tests.server.serving import rig, serving, text_of, until, until_closed, viewer
from tests.server.wire_examples import TINY_JPEG, example_frame, example_pose


class Clock:
    """A clock that is set by hand."""

    ns = 10_000_000_000

    def __call__(self) -> int:
        return self.ns


def samples(sessions: Sessions, relay: Relay | None = None) -> dict[str, float]:
    """Return the page's samples by name and labels."""
    page = Metrics(sessions, relay).page().decode()
    return {
        sample.name + "".join(f"|{value}" for value in sample.labels.values()): sample.value
        for family in text_string_to_metric_families(page)
        for sample in family.samples
    }


@pytest.fixture
def clock() -> Clock:
    return Clock()


def frame(frame_id: int) -> bytes:
    return encode_frame(example_frame(frame_id), TINY_JPEG)


def test_what_a_viewer_could_not_take_counts_as_dropped_and_the_rest_by_how_long_it_took(clock: Clock) -> None:
    sessions, viewer, wire = Sessions(clock, later=at_once), Mailbox(), Wire(room=1)
    session = sessions.open("walk")
    session.join(viewer)
    viewer.open(wire)
    session.take_binary(frame(1), clock.ns)
    session.take_binary(frame(2), clock.ns)
    session.take_binary(encode_pose(example_pose()), clock.ns)
    clock.ns += 4_000_000
    wire.make_room(1)
    clock.ns += 60_000_000
    wire.make_room(1)
    session.end(1000, "over")
    got = samples(sessions)
    assert got["agora_sessions"] == 1
    assert got["agora_frames_total|walk"] == 2
    assert got["agora_poses_total|walk"] == 1
    assert got["agora_frames_sent_total|walk"] == 1
    assert got["agora_frames_dropped_total|walk"] == 1
    assert got["agora_poses_sent_total|walk"] == 1
    assert got["agora_viewers|walk"] == 1
    assert got["agora_rig_connected|walk"] == 0
    assert got["agora_pose_age_seconds|walk"] == pytest.approx(0.064)
    assert got["agora_received_bytes_total|walk"] == 2 * len(frame(1)) + 112
    assert (got["agora_frame_fanout_seconds_bucket|0.003"], got["agora_frame_fanout_seconds_bucket|0.005"]) == (0, 1)
    assert got["agora_frame_fanout_seconds_sum"] == pytest.approx(0.004)
    assert (got["agora_pose_fanout_seconds_bucket|0.05"], got["agora_pose_fanout_seconds_count"]) == (0, 1)


def test_what_a_late_joiner_gets_at_once_is_not_timed(clock: Clock) -> None:
    sessions, viewer = Sessions(clock, later=at_once), Mailbox()
    session = sessions.open("walk")
    session.take_binary(frame(1), clock.ns)
    clock.ns += 60_000_000_000
    session.join(viewer)
    viewer.open(Wire())
    got = samples(sessions)
    assert got["agora_frames_sent_total|walk"] == 1
    assert got["agora_frame_fanout_seconds_count"] == 0
    assert got["agora_frame_age_seconds|walk"] == pytest.approx(60.0)


def test_a_session_that_made_room_leaves_no_series(clock: Clock) -> None:
    sessions = Sessions(clock, max_sessions=1)
    sessions.open("old")
    sessions.open("new")
    names = {key.partition("|")[2] for key in samples(sessions) if key.startswith("agora_viewers")}
    assert names == {"new"}


def test_refusals_are_counted_by_reason_and_the_process_is_there(clock: Clock) -> None:
    sessions = Sessions(clock)
    sessions.traffic.refused["malformed"] += 2
    got = samples(sessions)
    assert got["agora_refused_total|malformed"] == 2
    assert got["process_resident_memory_bytes"] > 1e6
    assert got["process_open_fds"] > 0


def test_joined_servers_are_counted(clock: Clock) -> None:
    sessions = Sessions(clock, later=at_once)
    relay = Relay(sessions, LocalBus(), "one")
    relay.peers["another"] = 0.0
    session = sessions.mirror("walk")
    session.mirror(None, {}, Mailbox())
    session.take_binary(frame(1), clock.ns)
    got = samples(sessions, relay)
    assert (got["agora_servers"], got["agora_bus_connected"]) == (2, 1)
    assert got["agora_rig_connected|walk"] == 0, "its rig is counted there"
    assert "agora_frame_age_seconds|walk" not in got


def test_a_duration_falls_into_the_class_whose_end_it_does_not_pass() -> None:
    durations = Durations()
    for seconds in (0.0, BOUNDS_S[3], BOUNDS_S[-1] * 2.0):
        durations.add(seconds)
    counts = dict(durations.cumulative())
    assert (counts[str(BOUNDS_S[0])], counts[str(BOUNDS_S[2])], counts[str(BOUNDS_S[3])]) == (1, 1, 2)
    assert (counts[str(BOUNDS_S[-1])], counts["+Inf"]) == (2, 3)


def test_those_turned_away_and_those_sent_off_are_counted(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", "server.sockets")
    with serving(tmp_path, sessions=Sessions(monotonic_ns, 1, 1)) as server:
        refused = server.app.state.sessions.traffic.refused
        with rig(server), viewer(server) as one:
            assert text_of(one, "hello")
            with pytest.raises(InvalidStatus):
                rig(server, "walk", "no token")
            with pytest.raises(InvalidStatus):
                rig(server, "second")
            for name in ("walk", "nobody"):
                with viewer(server, name) as other:
                    until_closed(other)
            one.send("no message")
            until_closed(one)
        until(lambda: refused == {"token": 1, "full": 2, "no_session": 1, "malformed": 1})
    events = [record.message for record in caplog.records if record.name == "server.sockets"]
    assert events[:2] == ["a rig came", "a viewer came"]
    assert sorted(events[2:]) == ["a rig left", "a viewer left"]
