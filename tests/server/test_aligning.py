"""What a viewer may ask of an alignment, and what the rig makes of it."""

import json
from math import inf
from typing import Any

import pytest

from server.aligning import Aligner
from server.errors import MalformedMessage
from server.messages import ControlRequest, Here, TakeBack, Tap, encode, parse_control, parse_from_viewer
from server.placing import Placing
from tracker.blank import CAMERA, blank_picture
from tracker.errors import InputError
from tracker.measurements import Frame, Retraction, Sighting, Standpoint
from tracker.simulate import AGORA_ORIGIN

TAP: dict[str, Any] = {
    "kind": "tap",
    "frame_id": 7,
    "place_px": [100.5, 20.0],
    "sigma_px": 4.0,
    "point_site_m": [1.0, 2.0, 3.0],
}
HERE: dict[str, Any] = {"kind": "here", "e_m": 3.0, "n_m": -4.0, "sigma_m": 0.5}


def request(value: object) -> ControlRequest:
    """Return what a viewer's message says, as it reaches the rig."""
    message = {"type": "control", "request_id": "v1", "action": "align", "value": value}
    asked = parse_from_viewer(json.dumps(message))
    assert isinstance(asked, ControlRequest)
    return parse_control(encode(asked))


def aligner(eyes_z_m: float = 1.9) -> Aligner:
    """Return one that has shown pictures 5 to 8 on level ground at 0.2 m."""
    of = Aligner(Placing(AGORA_ORIGIN, lambda e, n: 0.2, lambda e, n: eyes_z_m, 1.65))
    for number in range(5, 9):
        of.note(Frame(number * 1000, number * 1000 + 5, number, blank_picture()), None)
    return of


def test_an_alignment_reaches_the_rig_as_it_was_sent() -> None:
    assert request(TAP).value == Tap(7, (100.5, 20.0), 4.0, (1.0, 2.0, 3.0))
    assert request(HERE).value == Here(3.0, -4.0, 0.5)
    assert request({"kind": "undo"}).value == TakeBack()


@pytest.mark.parametrize(
    "value",
    [
        TAP | {"kind": "poke"},
        TAP | {"frame_id": -1},
        TAP | {"frame_id": 1.5},
        TAP | {"place_px": [1.0]},
        TAP | {"place_px": [1e9, 0.0]},
        TAP | {"sigma_px": 0.0},
        TAP | {"point_site_m": [1.0, 2.0, 1e9]},
        TAP | {"point_site_m": [1.0, 2.0, None]},
        TAP | {"more": 1},
        {"kind": "tap"},
        HERE | {"sigma_m": -1.0},
        HERE | {"e_m": "3"},
        {"kind": "undo", "all": True},
        [1.0],
    ],
)
def test_what_is_no_alignment_is_malformed(value: object) -> None:
    with pytest.raises(MalformedMessage):
        request(value)


def test_numbers_that_are_none_are_malformed() -> None:
    text = json.dumps({"type": "control", "request_id": "v1", "action": "align", "value": TAP | {"sigma_px": inf}})
    with pytest.raises(MalformedMessage):
        parse_from_viewer(text)


def test_a_tap_is_of_the_capture_of_its_own_picture() -> None:
    seen = aligner().said(request(TAP), CAMERA)
    assert isinstance(seen, Sighting)
    assert seen.t_ns == 7000
    assert seen.point_site_m == (1.0, 2.0, 3.0)
    x, y, z = seen.ray_cam
    assert (x / z, y / z) == pytest.approx(
        ((100.5 - CAMERA.cx_px) / CAMERA.fx_px, (20.0 - CAMERA.cy_px) / CAMERA.fy_px)
    )


def test_a_tap_in_a_picture_that_was_never_shown_is_refused() -> None:
    with pytest.raises(InputError, match="newer one"):
        aligner().said(request(TAP | {"frame_id": 4}), CAMERA)


def test_only_the_last_minute_of_pictures_is_remembered() -> None:
    of = aligner()
    for number in range(9, 3000):
        of.note(Frame(number * 1000, number * 1000, number, blank_picture()), None)
    with pytest.raises(InputError):
        of.said(request(TAP), CAMERA)
    of.note(Frame(99, 99, 7, blank_picture()), None)
    assert of.said(request(TAP), CAMERA).t_ns == 99, "a replay has shown it again"


def test_who_stands_on_the_plan_has_eyes() -> None:
    said = aligner().said(request(HERE), CAMERA)
    assert said == Standpoint(0, 0, (3.0, -4.0, 1.9), 0.5)
    nowhere = aligner(eyes_z_m=inf).said(request(HERE), CAMERA)
    assert isinstance(nowhere, Standpoint)
    assert nowhere.p_site_m[2] == pytest.approx(0.2 + 1.65)


def test_taking_back_and_nonsense() -> None:
    assert aligner().said(request({"kind": "undo"}), CAMERA) == Retraction(0, 0)
    for value in (None, 3.0, "here"):
        with pytest.raises(InputError, match="a tap, a place"):
            aligner().said(request(value), CAMERA)
