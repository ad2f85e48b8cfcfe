"""What visitors of simulated walks point out: near where it is, late, the same twice, and nothing that is not in sight."""

from pathlib import Path

import numpy as np
import pytest

from assets.records import Landmark
from assets.site import load_site
from server.pointing import DEMO_POINTINGS, Pointing, pointed_out
from tracker.errors import InputError
from tracker.measurements import Sighting
from tracker.simulate import DEMO_WALK, Walk, default_rig

LANDMARKS = load_site(Path(__file__).parents[2] / "assets" / "state_agora").landmarks


@pytest.fixture(scope="module")
def walk() -> Walk:
    return Walk(DEMO_WALK, default_rig())


def off_deg(walk: Walk, seen: Sighting) -> float:
    """Return the angle between what was said and the truth."""
    T_site_cam = walk.T_site_cam(seen.t_ns)
    p_cam_m = T_site_cam[:3, :3].T @ (np.array(seen.point_site_m) - T_site_cam[:3, 3])
    cosine = float(p_cam_m @ np.array(seen.ray_cam)) / float(np.linalg.norm(p_cam_m))
    return float(np.degrees(np.arccos(min(1.0, cosine))))


def test_the_demos_visitor_points_out_six_landmarks_within_a_finger(walk: Walk) -> None:
    """Never exactly: a finger of 4 px is half a degree."""
    said = list(pointed_out(walk, DEMO_POINTINGS, LANDMARKS))
    assert len(said) == len(DEMO_POINTINGS)
    errors = [off_deg(walk, seen) for seen in said]
    assert 0.05 < max(errors) < 2.0
    assert [seen.t_recv_ns for seen in said] == sorted(seen.t_recv_ns for seen in said)
    assert all(seen.t_recv_ns - seen.t_ns >= 1_000_000_000 for seen in said), "choosing takes time"
    assert said == list(pointed_out(walk, DEMO_POINTINGS, LANDMARKS))


def test_what_would_be_said_after_the_end_is_left_out(walk: Walk) -> None:
    end_s = walk.settings.duration_s
    assert list(pointed_out(walk, [Pointing("odeon_wall_east", end_s - 0.5)], LANDMARKS)) == []


@pytest.mark.parametrize(
    ("pointing", "landmarks", "words"),
    [
        (Pointing("prytaneion_column", 3.0), LANDMARKS, "prytaneion_column is not in the picture 3 s after the start."),
        (Pointing("pharos", 3.0), LANDMARKS[:1], f"There is no landmark pharos: there are {LANDMARKS[0].id}."),
    ],
)
def test_what_is_not_in_sight_cannot_be_pointed_out(
    walk: Walk, pointing: Pointing, landmarks: tuple[Landmark, ...], words: str
) -> None:
    with pytest.raises(InputError) as caught:
        list(pointed_out(walk, [pointing], landmarks))
    assert str(caught.value) == words
