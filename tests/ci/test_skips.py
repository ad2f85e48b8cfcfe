"""Tests of the rule that no test is skipped in silence."""

import pytest

from tests.ci.skips import ALLOWED_SKIPS, allowed_reasons


def test_no_other_reasons_are_allowed() -> None:
    """Recordings that cannot be published, and what a machine lacks that `make test` cannot bring."""
    reasons = {"../shared absent", "not root", "no gcc", "no systemd-analyze"}
    assert allowed_reasons(ALLOWED_SKIPS.read_text(encoding="utf-8")) == reasons


@pytest.mark.parametrize(
    ("body", "outcomes"),
    [
        ("pytest.skip('../shared absent')", {"skipped": 1}),
        ("pytest.skip('no time today')", {"failed": 1}),
        ("pytest.xfail('it never worked')", {"failed": 1}),
        ("pass", {"passed": 1}),
    ],
)
def test_an_unlisted_skip_fails(pytester: pytest.Pytester, body: str, outcomes: dict[str, int]) -> None:
    pytester.makepyfile(f"import pytest\ndef test_it():\n    {body}\n")
    pytester.runpytest("-p", "tests.ci.skips", "-p", "no:cacheprovider").assert_outcomes(**outcomes)


def test_a_whole_file_cannot_be_skipped_either(pytester: pytest.Pytester) -> None:
    pytester.makepyfile("import pytest\npytest.importorskip('a_module_that_is_not_there')\n")
    pytester.runpytest("-p", "tests.ci.skips", "-p", "no:cacheprovider").assert_outcomes(errors=1)
