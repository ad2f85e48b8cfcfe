"""A site's files: what is read, and one sentence for everything that is wrong with them."""

import math
import shutil
from pathlib import Path

import pytest

from assets.errors import SiteError
from assets.site import Site, load_site


@pytest.fixture
def folder(site: Site, tmp_path: Path) -> Path:
    for name in ("site.toml", "monuments.toml"):
        shutil.copy(site.folder / name, tmp_path / name)
    return tmp_path


def broken(folder: Path, name: str, old: str, new: str) -> str:
    """Return what loading says once `old` is `new` in file `name`."""
    file = folder / name
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(SiteError) as caught:
        load_site(folder)
    return str(caught.value)


def test_angles_are_turned_into_radians(site: Site) -> None:
    assert site.azimuth_rad == pytest.approx(math.radians(105.0))
    assert site.default_view.heading_rad == pytest.approx(math.radians(315.0))


def test_every_monument_has_its_id_names_and_a_credit(site: Site) -> None:
    assert len({m.id for m in site.monuments}) == len(site.monuments) > 20
    assert all(m.name["en"] and m.name["tr"] and m.caption["en"] for m in site.monuments)
    assert "OpenStreetMap" in site.attribution
    assert site.licence == "ODbL-1.0"


def test_shown_in_and_monument_choose(site: Site) -> None:
    assert "hercules_gate" not in {m.id for m in site.shown_in("roman")}
    assert "hercules_gate" in {m.id for m in site.shown_in("today")}
    assert site.monument("pollio").height_m == 6.4
    with pytest.raises(KeyError):
        site.monument("colosseum")


def test_a_figure_that_is_not_there_is_named(site: Site) -> None:
    with pytest.raises(SiteError, match=r"'pollio' of kind 'socle' needs the figure 'span_m'"):
        site.monument("pollio").measure("span_m")


@pytest.mark.parametrize("name", ["site.toml", "monuments.toml"])
def test_a_missing_file_is_named(folder: Path, name: str) -> None:
    (folder / name).unlink()
    with pytest.raises(SiteError, match=rf"{name} does not exist"):
        load_site(folder)


def test_a_file_that_cannot_be_read_is_named(folder: Path) -> None:
    (folder / "site.toml").unlink()
    (folder / "site.toml").mkdir()
    with pytest.raises(SiteError, match=r"site\.toml cannot be read"):
        load_site(folder)


def test_a_file_that_is_no_text_is_named(folder: Path) -> None:
    (folder / "site.toml").write_bytes(b"id = '\xff\xfe'")
    with pytest.raises(SiteError, match=r"site\.toml is not UTF-8"):
        load_site(folder)


@pytest.mark.parametrize(
    ("name", "old", "new", "says"),
    [
        ("site.toml", "[origin]", "[origin", "site.toml is not valid TOML"),
        ("site.toml", "lat_deg = 37.9366\n", "", "has no 'origin.lat_deg'; add it (a number)"),
        ("site.toml", "lat_deg = 37.9366", "lat_deg = nan", "'origin.lat_deg' must be a number, not nan"),
        ("site.toml", "lat_deg = 37.9366", "lat_deg = true", "'origin.lat_deg' must be a number, not True"),
        ("site.toml", "lat_deg = 37.9366", "lat_deg = 97.0", "'origin.lat_deg' is 97, outside -90 to 90"),
        ("site.toml", 'id = "state_agora"', "id = 7", "'id' must be a text, not 7"),
        (
            "site.toml",
            '{ en = "In the square", tr = "Meydanda" }',
            '{ tr = "Meydanda" }',
            "has no 'default_view.name.en'",
        ),
        ("site.toml", "[[tour]]", "[tour]", "is not valid TOML"),
        ("site.toml", "[-2.6, -9.7]", "[-2.6]", "'ways[0]' must be at least three pairs of numbers"),
        ("monuments.toml", 'epochs = ["roman", "today"]', 'epochs = ["iron"]', "'basilica_stoa.epochs' may hold only"),
        (
            "monuments.toml",
            'evidence = "inferred"',
            'evidence = "sure"',
            "'basilica_stoa.evidence' is 'sure', not one of",
        ),
        (
            "monuments.toml",
            "[-103.72, 31.73]",
            '["x", 31.73]',
            "'basilica_stoa.footprint.value' must be at least three",
        ),
        (
            "monuments.toml",
            "[-103.72, 31.73]",
            "[inf, 31.73]",
            "'basilica_stoa.footprint.value' must be at least three",
        ),
        ("monuments.toml", "height_m = {", "h = {", "has no 'basilica_stoa.figures.height_m'"),
        (
            "monuments.toml",
            "value = 13.1",
            'value = "13"',
            "'basilica_stoa.figures.height_m.value' must be a number, not '13'",
        ),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence_with_file_and_key(
    folder: Path, name: str, old: str, new: str, says: str
) -> None:
    sentence = broken(folder, name, old, new)
    assert says in sentence
    assert name in sentence
    assert "\n" not in sentence
    assert sentence.endswith(".")


def test_tour_stops_must_be_tables(folder: Path) -> None:
    file = folder / "site.toml"
    text = file.read_text(encoding="utf-8")
    before, _, after = text.partition("[[tour]]")
    terrain = after[after.index("\n[terrain]") :]
    file.write_text(before.replace("id =", "tour = [1]\nid =", 1) + terrain, encoding="utf-8")
    with pytest.raises(SiteError, match=r"'tour' must hold tables, not 1"):
        load_site(folder)
