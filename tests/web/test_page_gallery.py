"""Every page in its states, themes and languages: as it looked when somebody last looked at it, in nobody's way, and translated.

After a change that is meant to be seen: `make gallery`, and look at tests/golden/pages.
"""

import re
from collections.abc import Iterator, Mapping

import pytest
from playwright.sync_api import Browser

from tests.web.likeness import LEAST_LIKENESS, MOST_BLEMISH, Picture, blemish, kept, likeness
from tests.web.page_gallery import GOLDEN, served
from tests.web.visiting import LANGUAGES, Visit, table, visit

pytestmark = [pytest.mark.browser, pytest.mark.slow]

KINDS = table()[1]
MOST_BYTES = 3_000_000
SAME = re.compile(r"[A-Z?]|Home|End|truth|[a-z-]+/[a-z]+|\d+ m|Hydreion|Prytaneion")
"""Texts that are rightly alike in two languages: keys, lengths, names, and estimators as commands have them."""


@pytest.fixture(scope="module")
def urls(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mapping[str, str]]:
    """Where the pages are."""
    with served(tmp_path_factory.mktemp("pages")) as urls:
        yield urls


@pytest.fixture(scope="module", params=KINDS)
def visits(request: pytest.FixtureRequest, browser: Browser, urls: Mapping[str, str]) -> dict[str, Visit]:
    """One page, visited in every language."""
    kind = KINDS[str(request.param)]
    return {language: visit(browser, urls[kind.server], kind, language) for language in LANGUAGES}


def golden(name: str) -> Picture:
    """Return the picture that is kept."""
    return kept(GOLDEN / f"{name}.webp", "make gallery")


def test_a_page_looks_as_it_did(visits: dict[str, Visit]) -> None:
    changed = {}
    for seen in visits.values():
        for shot in seen.shots:
            before = golden(shot.name)
            assert shot.picture.shape == before.shape, shot.name
            off, like = blemish(shot.picture, before), likeness(shot.picture, before)
            if off > MOST_BLEMISH or like < LEAST_LIKENESS:
                changed[shot.name] = (round(off, 1), round(like, 3))
    assert changed == {}


def test_a_page_is_in_nobodys_way(visits: dict[str, Visit]) -> None:
    amiss = {state: found for seen in visits.values() for state, found in seen.findings.items() if found}
    assert amiss == {}


def test_no_text_of_a_page_is_in_one_language_alone(visits: dict[str, Visit]) -> None:
    english, turkish = (visits[language].said for language in ("en", "tr"))
    untranslated = {}
    for state, texts in english.items():
        both = {text for text in set(texts) & set(turkish[state]) if any(map(str.isalpha, text))}
        if left := sorted(text for text in both if SAME.fullmatch(text) is None):
            untranslated[state] = left
    assert untranslated == {}


@pytest.mark.parametrize("name", KINDS)
def test_no_state_of_a_page_passes_for_another(name: str) -> None:
    """In each language a wide picture, or the one in the glare theme, is another."""
    for language in LANGUAGES:
        shown = [
            (state.name, [golden(f"{name}.{state.name}.{language}.{look}") for look in looks])
            for state in KINDS[name].states
            for looks in [("plain.wide", "glare.narrow" if state.narrow else "glare.wide")]
        ]
        for index, (state, pictures) in enumerate(shown):
            for other, others in shown[index + 1 :]:
                assert max(map(blemish, pictures, others)) > MOST_BLEMISH, (state, other)


def test_all_that_is_kept_is_compared_and_it_is_little() -> None:
    files = {path.stem: path.stat().st_size for path in GOLDEN.iterdir()}
    compared = {
        f"{kind.name}.{state.name}.{language}.{theme}"
        for kind in KINDS.values()
        for state in kind.states
        for language in LANGUAGES
        for theme in (("plain.wide", "plain.narrow", "glare.narrow") if state.narrow else ("plain.wide", "glare.wide"))
    }
    assert files.keys() == compared
    assert sum(files.values()) < MOST_BYTES
