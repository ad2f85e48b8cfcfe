"""Landmarks: points of what stands today, where visitors will look for them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from assets.checks import check_landmarks
from assets.errors import SiteError
from assets.gltf import Scene
from assets.records import Landmark
from assets.site import LANGUAGES, Site, load_site

FILE = Path("site.toml")


def test_each_is_a_point_of_its_monument_as_it_stands(site: Site, today: Scene) -> None:
    """A corner, or the middle of a column's top: within half a capital of what is drawn, and at the height of it."""
    assert len(site.landmarks) >= 8
    for landmark in site.landmarks:
        nodes = [node for node in today.nodes if node.extras.get("monument") == landmark.monument]
        drawn = np.concatenate([mesh.positions_m for node in nodes for mesh in node.meshes])
        near = drawn[np.hypot(*(drawn[:, :2] - landmark.point_m[:2]).T) < 0.75]
        assert len(near) > 0, landmark.id
        assert near[:, 2].max() == pytest.approx(landmark.point_m[2], abs=0.1), landmark.id


def test_they_lie_all_around_the_square(site: Site) -> None:
    """Wherever one looks from its middle, one of them is within 60 degrees."""
    bearings = np.sort([np.arctan2(x.point_m[0] + 20.0, x.point_m[1] + 20.0) for x in site.landmarks])
    gaps = np.diff([*bearings, bearings[0] + 2.0 * np.pi])
    assert gaps.max() < np.radians(120.0)


def test_they_are_named_in_both_languages_and_told_apart(site: Site) -> None:
    for language in LANGUAGES:
        names = [landmark.name[language] for landmark in site.landmarks]
        assert all(names)
        assert len(set(names)) == len(names)


def test_a_landmark_of_what_does_not_stand_is_refused(site: Site) -> None:
    lost = Landmark("lost", {"en": "Lost"}, "nothing", (0.0, 0.0, 0.0))
    with pytest.raises(
        SiteError, match=r"'landmark\[0\]\.monument' is 'nothing', which is no monument that stands today"
    ):
        check_landmarks(FILE, [lost], site.monuments)
    first = site.landmarks[0]
    with pytest.raises(SiteError, match=r"'landmark\[1\]\.id' is 'odeon_wall_west', which an earlier landmark has"):
        check_landmarks(FILE, [first, replace(first, monument="pollio")], site.monuments)


def test_a_point_has_three_numbers_and_a_site_may_have_no_landmarks(tmp_path: Path, site: Site) -> None:
    for name in ("site.toml", "monuments.toml"):
        (tmp_path / name).write_text((site.folder / name).read_text())
    path = tmp_path / "site.toml"
    text = path.read_text()
    path.write_text(text.replace("point_m = [-5.9, 28.4, 3.76]", "point_m = [-5.9, 28.4]"))
    with pytest.raises(SiteError, match=r"landmark\[0\]\.point_m.*triples"):
        load_site(tmp_path)
    head, _, rest = text.partition("[[landmark]]")
    path.write_text(head + rest[rest.index("[terrain]") :])
    assert load_site(tmp_path).landmarks == ()
