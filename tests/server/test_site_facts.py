"""What a page is told of a site: models with their levels, captions and tour in two languages, rivals and evidence."""

import json
from hashlib import sha256
from pathlib import Path
from typing import Any, get_args

import pytest

from assets.site import LANGUAGES, Evidence, Site, load_site
from server.site_facts import site_facts
from server.site_tour import tour_of
from tracker.choreography import AGORA_TOUR

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def site() -> Site:
    return load_site(ROOT / "assets" / "state_agora")


@pytest.fixture
def facts(site: Site, tmp_path: Path) -> dict[str, Any]:
    names = ("today.0", "roman.1", "roman.0", "roman.2", "materials", "occluders", "kiosk")
    for name in names:
        (tmp_path / f"{name}.glb").write_text(name, encoding="utf-8")
    return site_facts(site, tmp_path)


def address(name: str) -> str:
    """Return the address of a model whose content is its name."""
    return f"/models/{name}.glb?v={sha256(name.encode()).hexdigest()[:12]}"


def test_it_is_json(facts: dict[str, Any]) -> None:
    assert json.loads(json.dumps(facts)) == facts


def test_models_have_their_levels_in_order(facts: dict[str, Any]) -> None:
    assert facts["models"] == {
        "kiosk": address("kiosk"),
        "roman": {"levels": [address("roman.0"), address("roman.1"), address("roman.2")]},
        "today": {"levels": [address("today.0")]},
    }


def test_a_models_address_names_its_content(site: Site, facts: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "kiosk.glb").write_text("another", encoding="utf-8")
    later = site_facts(site, tmp_path)["models"]
    assert later["kiosk"] != facts["models"]["kiosk"]
    assert later["roman"] == facts["models"]["roman"]


def test_what_stands_beside_the_models_is_named_or_null(facts: dict[str, Any]) -> None:
    assert facts["occluders"] == address("occluders")
    assert facts["materials"] == address("materials")
    assert facts["walkable"] is None


@pytest.mark.parametrize("language", LANGUAGES)
def test_captions_come_in_both_languages_with_their_status(facts: dict[str, Any], language: str) -> None:
    captions = [m["captions"][language] for m in facts["monuments"]]
    assert all(captions)
    assert {m["caption_status"] for m in facts["monuments"]} == {"unreviewed"}


def test_the_tour_is_told_stop_by_stop(site: Site, facts: dict[str, Any]) -> None:
    assert [stop["id"] for stop in facts["tour"]] == [stop.id for stop in site.tour]
    first = facts["tour"][0]
    assert set(first["texts"]) == set(LANGUAGES)
    assert (first["monument"], first["e_m"], first["heading_rad"]) == ("square", 42.0, site.tour[0].heading_rad)
    assert facts["default_view"]["names"] == {"en": "In the square", "tr": "Meydanda"}


def test_rivals_and_attributions_say_why(facts: dict[str, Any]) -> None:
    monuments = {m["id"]: m for m in facts["monuments"]}
    memmius = monuments["memmius"]
    assert memmius["default_variant"] in {v["id"] for v in memmius["variants"]} == {"arch", "tower"}
    readings = [r for m in facts["monuments"] for r in (*m["variants"], *m["attributions"])]
    for reading in readings:
        assert set(reading["why"]) == set(LANGUAGES)
        assert reading["evidence"] in get_args(Evidence)
        assert set(reading["sources"]) <= set(facts["sources"])
    assert {a["id"] for a in monuments["temple_agora"]["attributions"]} == {"isis", "augustus", "caesar_roma"}
    assert monuments["pollio"]["variants"] == []
    assert monuments["pollio"]["default_variant"] is None


def test_evidence_has_words_in_both_languages(facts: dict[str, Any]) -> None:
    assert set(facts["evidence"]) == set(get_args(Evidence))
    assert all(set(words) == set(LANGUAGES) for words in facts["evidence"].values())


def test_the_tour_of_a_walk_is_in_the_data(site: Site) -> None:
    assert tour_of(site) == AGORA_TOUR


def test_landmarks_are_told_with_their_points(site: Site, facts: dict[str, Any]) -> None:
    assert len(facts["landmarks"]) == len(site.landmarks) > 0
    first = facts["landmarks"][0]
    assert first["point_site_m"] == list(site.landmarks[0].point_m)
    assert set(first["names"]) == set(LANGUAGES)
