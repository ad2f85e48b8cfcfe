"""What the console makes of the messages that every viewer gets."""

from dataclasses import replace

import numpy as np
import pytest

from server import messages
from server.console.saving import table
from server.console.status import plain, rejected_of, status_of
from server.console.walk import Walk
from server.errors import MalformedMessage
from server.messages import Company, ControlReply, Figures, Update, encode
from server.session import Session
from server.wire import FrameMeta, encode_frame
from tests.server.wire_examples import TINY_JPEG, example_frame


def session(**fields: object) -> dict[str, object]:
    """Return a session's description."""
    return Session("walk").describe() | {"kind": "replay", "estimator": "gps-imu/famm"} | fields


def told(*, sees: bool = True, **fields: object) -> Walk:
    """Return a walk that was told of its session."""
    walk = Walk("walk")
    walk.take_text(messages.hello(session(**fields), role="operator", sees=sees, number=1))
    return walk


def at(position_s: float, north_m: float, *, did_seek: bool = False) -> FrameMeta:
    """Return a frame some way on."""
    frame = example_frame(int(position_s * 10), position_s=position_s, did_seek=did_seek)
    T_site_cam = frame.T_site_cam.copy()
    T_site_cam[1, 3] = north_m
    return replace(frame, T_site_cam=T_site_cam)


def figures(*times_s: float, anew: bool = False) -> str:
    """Return figures with an update at each of some times, one metre for each second."""
    updates = [Update(t, t, 0.1, "P1R1") for t in times_s]
    return encode(Figures(anew=anew, updates=updates, rejected={"rejected_gate": 2}))


def test_frames_make_a_path_and_a_history() -> None:
    walk = told()
    for i in range(5):
        walk.take_frame(encode_frame(at(0.1 * i, 0.5 * i), TINY_JPEG))
    assert [len(piece) for piece in walk.path.pieces] == [4]
    assert walk.unacknowledged == [0, 1, 2, 3, 4]
    times_s, sigmas_m, headings_deg = walk.history.doubts()
    assert times_s.tolist() == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert sigmas_m[0] == pytest.approx(np.sqrt(0.5))
    assert headings_deg[0] == pytest.approx(np.degrees(0.2))


def test_a_seek_begins_the_chart_anew_and_does_not_join_the_path() -> None:
    walk = told()
    for frame in (at(0.0, 0.0), at(0.1, 1.0), at(9.0, 2.0, did_seek=True), at(9.1, 3.0)):
        walk.take_frame(encode_frame(frame, TINY_JPEG))
    assert len(walk.path.pieces[0]) == 2
    assert walk.history.doubts()[0].tolist() == [9.0, 9.1]


def test_another_estimator_begins_anew() -> None:
    walk = told()
    for i in range(3):
        walk.take_frame(encode_frame(at(0.1 * i, 1.0 * i), TINY_JPEG))
    walk.take_text(messages.state(session(estimator="gps-imu/precise")))
    assert walk.path.pieces == [[]]
    assert walk.history.doubts().shape == (3, 0)


def test_figures_take_the_place_of_those_they_go_back_behind() -> None:
    walk = told()
    walk.take_text(figures(1.0, 2.0, 3.0))
    walk.take_text(figures(2.5, 3.5))
    assert walk.history.innovations()[0].tolist() == [1.0, 2.0, 2.5, 3.5]
    walk.take_text(figures(7.0, anew=True))
    assert walk.history.innovations()[:, 0].tolist() == pytest.approx([7.0, 7.0, np.degrees(0.1)])
    assert "rejected gate | 2" in rejected_of(walk)


def test_long_charts_are_thinned_out_and_end_with_the_newest() -> None:
    walk = told()
    for start in range(0, 2000, 250):
        walk.take_text(figures(*(float(i) for i in range(start, start + 250))))
    times_s = walk.history.innovations()[0]
    assert len(times_s) <= 600
    assert times_s[-1] == 1999.0


def test_a_picture_is_shown_to_those_who_may_see_it_or_while_it_is_shared() -> None:
    hidden = told(sees=False)
    hidden.take_frame(encode_frame(at(0.0, 0.0), TINY_JPEG))
    assert not hidden.has_picture
    hidden.take_text(messages.state(session(sharing=True)))
    assert hidden.has_picture


def test_company_is_counted_and_what_a_newer_server_says_is_passed_over() -> None:
    walk = told()
    walk.take_text(encode(Company(watching=4, seen=[])))
    assert walk.take_text('{"type":"weather","sun":true}') is None
    assert "3 viewers" in status_of(walk)


def test_replies_are_handed_on_and_poses_passed_over() -> None:
    walk = told()
    assert walk.take_text(encode(ControlReply("7", ok=True))) == ControlReply("7", ok=True)
    assert not walk.take_frame(b"AGP1" + bytes(108))


def test_what_is_no_message_is_refused() -> None:
    for text in ("{", "[]", '{"type":"hello"}', '{"type":"state","session":{"name":1}}'):
        with pytest.raises(MalformedMessage):
            told().take_text(text)


def test_the_status_tells_place_doubt_and_troubles_and_takes_no_markup() -> None:
    health = {"gps": {"trouble": True, "sentence": "<script>", "state": "lost", "rate_hz": 0.0}}
    walk = told(notice="![x](/etc/passwd)", health=health)
    walk.take_frame(encode_frame(at(0.0, 4.0), TINY_JPEG))
    status = status_of(walk)
    assert "2.00, 4.00, 1.70 m" in status
    assert "0.71 m, 11.5°" in status
    assert "0° from north" in status
    assert "![x]" not in status
    assert "\\<script\\>" in status
    assert plain("a_b*c") == "a\\_b\\*c"


def test_the_table_has_every_place() -> None:
    walk = told()
    for i in range(3):
        walk.take_frame(encode_frame(at(0.5 * i, 0.01 * i), TINY_JPEG))
    rows = table(walk).decode().splitlines()
    assert rows[0].startswith("time_s,east_m")
    assert rows[1:] == [f"{0.5 * i:.3f},2.000,{0.01 * i:.3f},1.700,0.707,P1R0" for i in range(3)]
