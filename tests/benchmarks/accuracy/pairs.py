"""The precise filter against every other entrant, walk by walk: both have met the same errors."""

from collections.abc import Mapping

from server.paper.statistics import paired
from tests.benchmarks.accuracy.goals import BOTH
from tracker.score import Figures

COMPARED = ("ate_m", "debiased_m", "heading_deg", "tilt_deg", "jitter_walking_m", "outage_end_m")


def against(table: Mapping[tuple[str, str], Mapping[int, Figures]]) -> list[Figures]:
    """Return a row for each scenario, filter of ours, rival and figure that both tell on at least two walks.

    Args:
        table: Rows by scenario and estimator, then by seed.
    """
    found = []
    for scenario, rival in sorted(table):
        for ours in BOTH:
            if rival in BOTH or (scenario, ours) not in table:
                continue
            for figure in COMPARED:
                pairs = _pairs(table[scenario, ours], table[scenario, rival], figure)
                if len(pairs) >= 2:
                    what = {"scenario": scenario, "estimator": ours, "rival": rival, "figure": figure}
                    found.append(what | paired([a for a, _ in pairs], [b for _, b in pairs]))
    return found


def _pairs(ours: Mapping[int, Figures], theirs: Mapping[int, Figures], figure: str) -> list[tuple[float, float]]:
    both = [(ours[seed].get(figure), theirs[seed].get(figure)) for seed in sorted(set(ours) & set(theirs))]
    return [(a, b) for a, b in both if a is not None and b is not None and b > 0.0]
