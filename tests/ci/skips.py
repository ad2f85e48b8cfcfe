"""A pytest plugin: a skip counts as a failure unless `tests/allowed_skips.txt` lists its reason."""

from collections.abc import Generator
from pathlib import Path

import pytest

ALLOWED_SKIPS = Path(__file__).parents[1] / "allowed_skips.txt"


def allowed_reasons(text: str) -> frozenset[str]:
    """Return the reasons listed in `text`: lines of `REASON: why`, with `#` before remarks."""
    lines = (line.strip() for line in text.splitlines())
    return frozenset(line.partition(": ")[0] for line in lines if line and not line.startswith("#"))


def skip_reason(report: pytest.TestReport | pytest.CollectReport) -> str | None:
    """Return why the test or file of `report` did not count, or None where it did; an expected failure is no excuse either."""
    if not report.skipped:
        return None
    if hasattr(report, "wasxfail"):
        return f"expected to fail: {report.wasxfail}"
    return str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr).removeprefix("Skipped: ")


def refuse_unlisted(report: pytest.TestReport | pytest.CollectReport) -> None:
    """Turn `report` into a failure where it is a skip for a reason that is not listed."""
    reason = skip_reason(report)
    if reason is not None and reason not in allowed_reasons(ALLOWED_SKIPS.read_text(encoding="utf-8")):
        report.outcome = "failed"
        report.longrepr = (
            f"{report.nodeid} was skipped ({reason}), and tests/allowed_skips.txt does not list that reason"
        )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    refuse_unlisted(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    refuse_unlisted(report)
    return report
