"""A site's files: what is read, and one sentence for everything that is wrong with them."""

import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import shapely

from assets.errors import SiteError
from assets.site import LANGUAGES, Site, load_site


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


def sentences(text: str) -> int:
    """Count sentences; a dot inside a number or after one ends none."""
    return len(re.findall(r"(?<!\d)[.!?](?=\s|$)|(?<=\d)[.!?](?=\s[A-ZÇĞİÖŞÜ]|$)", text))


@pytest.mark.parametrize(
    ("text", "count"), [("One. Two!", 2), ("It is 6.4 metres high.", 1), ("MÖ 6. yüzyıl. Var.", 2)]
)
def test_sentences_are_counted(text: str, count: int) -> None:
    assert sentences(text) == count


def test_every_monument_has_its_id_names_and_a_credit(site: Site) -> None:
    assert len({m.id for m in site.monuments}) == len(site.monuments) > 20
    assert all(m.name["en"] and m.name["tr"] for m in site.monuments)
    assert "OpenStreetMap" in site.attribution
    assert site.licence == "ODbL-1.0"


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_monument_has_a_caption_of_its_own(site: Site, language: str) -> None:
    captions = [m.caption[language] for m in site.monuments]
    assert len(set(captions)) == len(captions)
    assert {sentences(caption) for caption in captions} <= {2, 3, 4}


def test_nobody_claims_that_the_captions_were_reviewed(site: Site) -> None:
    assert {m.caption_status for m in site.monuments} == {"unreviewed"}


def test_everything_that_is_said_has_a_source(site: Site) -> None:
    for m in site.monuments:
        told = [*m.sources, m.footprint.source, *(figure.source for figure in m.figures.values())]
        told += [key for reading in (*m.variants, *m.attributions) for key in reading.sources]
        assert set(told) <= set(site.sources)
        assert m.sources


def test_design_values_are_told_from_evidence(site: Site) -> None:
    for m in site.monuments:
        for name, figure in m.figures.items():
            assert figure.confidence == "D" or figure.source != "design", f"{m.id}.{name}"


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_tour_is_spoken_in_eight_to_ten_stops(site: Site, language: str) -> None:
    assert 8 <= len(site.tour) <= 10
    words = {stop.id: len(stop.text[language].split()) for stop in site.tour}
    assert all(40 <= count <= 80 for count in words.values()), words


def test_a_stop_looks_at_its_monument(site: Site) -> None:
    for stop in site.tour:
        outline = shapely.Polygon(site.monument(stop.monument).footprint.corners_en_m)
        way = np.array([math.sin(stop.heading_rad), math.cos(stop.heading_rad)])
        ahead = np.array([stop.e_m, stop.n_m]) + np.outer([0.0, 150.0], way)
        assert shapely.LineString(ahead).distance(outline) < 1.0, stop.id


def test_rivals_are_chosen_by_name(site: Site) -> None:
    memmius = site.monument("memmius")
    assert {v.id for v in memmius.variants} == {"arch", "tower"}
    assert memmius.as_variant() == memmius.as_variant("tower")
    assert memmius.as_variant("arch").height_m < memmius.height_m
    assert site.monument("temple_agora").variant("absent") in site.monument("temple_agora").variants
    assert site.monument("pollio").variant() is None
    assert site.monument("pollio").as_variant() is site.monument("pollio")


@pytest.mark.parametrize(("monument", "known"), [("memmius", "tower, arch"), ("pollio", "none")])
def test_an_unknown_variant_is_refused(site: Site, monument: str, known: str) -> None:
    with pytest.raises(SiteError, match=rf"'{monument}' has no variant 'pyramid'; it has: {known}\."):
        site.monument(monument).variant("pyramid")


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
            "height_m = { value = 13.1",
            "height_m = { value = -13.1",
            "is -13.1, but must be more than 0",
        ),
        ("monuments.toml", "height_m = { value = 13.1", "height_m = { value = 0", "is 0, but must be more than 0"),
        ("monuments.toml", "aisle_m = { value = 4.72", "aisle_m = { value = -4.72", "is -4.72, but must be 0 or more"),
        ("monuments.toml", 'kind = "basilica"', 'kind = "mall"', "'basilica_stoa.kind' is 'mall', not one of altar"),
        ("monuments.toml", 'order = "bull"', 'order = "rococo"', "'basilica_stoa.order' is 'rococo', not one of doric"),
        ("monuments.toml", 'sources = ["SAM", "EHW"', 'sources = ["XYZ", "EHW"', "'basilica_stoa.sources' names 'XYZ'"),
        ("monuments.toml", 'sources = ["SAM", "EHW", "VICI", "SHO"]\n', "", "has no 'basilica_stoa.sources'"),
        ("monuments.toml", 'sources = ["SAM", "EHW", "VICI", "SHO"]', "sources = []", "is empty; name at least one"),
        ("monuments.toml", 'source = "OSM"', 'source = "hearsay"', "'basilica_stoa.footprint.source' is 'hearsay'"),
        (
            "monuments.toml",
            'unit = "m", source = "design", note',
            'unit = "m", note',
            "has no 'basilica_stoa.figures.base_z_m.source'",
        ),
        (
            "monuments.toml",
            'caption_status = "unreviewed"',
            'caption_status = "fine"',
            "'basilica_stoa.caption_status' is 'fine'",
        ),
        ("monuments.toml", 'caption_status = "unreviewed"\n', "", "has no 'basilica_stoa.caption_status'"),
        ("monuments.toml", 'tr = "Yaklaşık 160', 'xx = "Yaklaşık 160', "has no 'basilica_stoa.caption.tr'"),
        (
            "monuments.toml",
            'default_variant = "tower"',
            'default_variant = "pyramid"',
            "'memmius.default_variant' is 'pyramid'",
        ),
        ("monuments.toml", 'default_variant = "tower"\n', "", "has no 'memmius.default_variant'"),
        ("site.toml", 'monument = "basilica_stoa"', 'monument = "mall"', "'tour[1].monument' is 'mall'"),
        ("site.toml", 'id = "basilica"', 'id = "long_axis"', "'tour[1].id' is 'long_axis', which an earlier stop has"),
        ("site.toml", "[17.9, 27.0, 7.0]", "[17.9, 27.0]", "'sights' must hold triples of numbers"),
        ("site.toml", 'SAM = "insel', 'SAM = "" #', "'sources.SAM' is empty; say something"),
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
