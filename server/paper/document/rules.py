"""The fuzzy controller as the document shows it: memberships, outputs, rules, which of them fire, and the reduced rule base."""

from collections import Counter

from server.blocks import Block, Grid, Heading, Shown, Text
from server.paper.document.results import Results
from server.plots.controller import (
    OUTPUT_CAPTION,
    membership_caption,
    membership_figure,
    output_figure,
    rule_caption,
    rule_figure,
)
from server.plots.style import drawn
from tracker.fuzzy import LEVELS, NEXT_INDEX, RULES

_SHOWN = 12


def rules(results: Results) -> list[Block]:
    """Return the section on the controller."""
    reduced = tuple((level, *(str(following) for following in NEXT_INDEX[level])) for level in LEVELS)
    blocks: list[Block] = [
        Heading("The fuzzy controller"),
        Text(
            "Two innovations and the present model go in, the next model comes out. Firing strengths are products of the two "
            "degrees of membership, the strongest rule wins, and its output is a singleton, as in the paper."
        ),
        Shown(drawn(membership_figure(), "memberships", membership_caption())),
        Shown(drawn(output_figure(), "outputs", OUTPUT_CAPTION)),
        Shown(drawn(rule_figure(), "rules", rule_caption())),
        Text(
            "Because the strongest rule wins outright, what is fuzzy about it does not reach the filter: the degrees only place "
            "two thresholds on each innovation, and FAMM is a crisp automaton that changes state there. The maximum of products "
            "over two independent sets is the product of the two maxima, so each set is searched alone and the rule is one look-up."
        ),
        Heading("The reduced rule base", 3),
        Text(
            "The paper's future work asks for fewer rules. The 81 reduce to nine without any loss: [[reduced]], used once for the "
            "position's index and once for the rotation's, gives every consequent of the whole table. A test compares all 81, and "
            "the estimator `reduced` runs it beside FAMM: the same poses, bit for bit."
        ),
        Grid(
            "reduced",
            "The reduced rule base: the index that follows 0, 1 and 2.",
            ("innovation", "after 0", "after 1", "after 2"),
            reduced,
        ),
    ]
    return blocks + _fired(results)


def _fired(results: Results) -> list[Block]:
    """Return which rules fire, by dataset."""
    fired = {d: Counter[str]() for d in range(1, 6)}
    for row in results.rows:
        if row["model"] == "famm" and row["sensors"] == "camera-gps-imu":
            fired[row["dataset"]].update(row.get("rules_fired") or {})
    total = sum(fired.values(), Counter[str]())
    if not total:
        return []
    rows = tuple(
        (f"`{name}`", f"`{_consequent(name)}`", *(_share(fired[d], name) for d in fired), _share(total, name))
        for name, _ in total.most_common(_SHOWN)
    )
    covered = sum(n for _, n in total.most_common(_SHOWN)) / total.total()
    return [
        Grid(
            "fired",
            f"The {_SHOWN} rules that fire most often with the camera, in per cent of a dataset's updates. Together they make "
            f"{100.0 * covered:.0f} % of all updates; {len(total)} of {len(RULES)} rules fire at all.",
            ("rule", "gives", *(f"dataset {d}" for d in fired), "all"),
            rows,
            left=2,
        )
    ]


def _consequent(name: str) -> str:
    return next(str(after) for (y_p, y_r, model), after in RULES.items() if f"{y_p},{y_r},{model}" == name)


def _share(counts: Counter[str], name: str) -> str:
    return f"{100.0 * counts[name] / counts.total():.1f}" if counts.total() else "–"
