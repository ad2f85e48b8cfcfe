"""The sweep: where the defaults come from, what each factor does, what wins a lost cell, and the price of resting."""

from collections.abc import Sequence

from server.blocks import Block, Grid, Heading, Items, Shown, Text
from server.paper.document.results import Results
from server.paper.document.words import cell_name, count, listed, percent
from server.plots.sensitivity import crossings, sensitivity_caption, sensitivity_figure
from server.plots.style import drawn
from server.tables import once
from tracker.score import Figures

#: Factors that are drawn, or told in words; the others are a table.
_DRAWN = frozenset({"default", "position", "rotation", "rest"})


def sensitivity(results: Results) -> list[Block]:
    """Return the section; empty without a sweep."""
    sweep = results.sweep
    if sweep is None:
        return []
    default, variants = sweep["default"], sweep["variants"]
    cells = len(default["cells"])
    figure = sensitivity_figure(variants, default, cells)
    return [
        Heading("Sensitivity"),
        Text(
            f"{len(variants)} variants were filtered on seeds {min(sweep['seeds'])} to {max(sweep['seeds'])}, which no other table "
            "uses. What the sensors say does not depend on the filter, so each walk is recorded once and filtered by every "
            "variant; Q and R are always shared by CMM and FAMM."
        ),
        Shown(drawn(figure, "sensitivity", sensitivity_caption(variants, default, cells))),
        Text(f"**The rule by which defaults are chosen.** {sweep['rule']}"),
        Text(_chosen(sweep)),
        _factors(variants, default, sweep["rules"], cells),
        *_lost(sweep),
        *_resting(sweep),
    ]


def _chosen(sweep: Figures) -> str:
    """Say what the rule picks, and whether that is what is shipped."""
    default, parts = sweep["default"], []
    for name, key, wins, unit in (
        ("position", "position_m", "wins", "m"),
        ("rotation", "rotation_rad", "rotation_wins", "rad"),
    ):
        best = sweep[f"chosen_{name}"]
        low, high = crossings(best[key])
        same = best[key] == default[key]
        shipped = "which is what is shipped" if same else f"the shipped ones win {count(default[wins])}"
        parts.append(f"for {name} crossings at {low:.3g} and {high:.3g} {unit} ({_cells(best[wins])} won; {shipped})")
    return f"It picks {listed(parts)}."


def _factors(variants: Sequence[Figures], default: Figures, meanings: Figures, cells: int) -> Grid:
    rows = [_row("default", "as shipped", default, cells)]
    for factor in dict.fromkeys(row["factor"] for row in variants if row["factor"] not in _DRAWN):
        for row in (row for row in variants if row["factor"] == factor):
            value = f"{row['value']}: {meanings[row['value']]}" if factor == "rules" else row["value"]
            rows.append(_row(factor, value, row, cells))
    caption = (
        "One factor at a time around the defaults. Cells in which FAMM's mean filter error is below CMM's, those in which its "
        "median ATE is at most 1.00 of CMM's, the mean step of its error as a multiple of CMM's, and FAMM's mean filter error and "
        "ATE over the cells."
    )
    head = ("factor", "value", "cells won", "surely", "ATE kept", "tremble", "filter error, m", "ATE, m")
    return Grid("factors", caption, head, once(rows), left=2)


def _row(factor: str, value: str, row: Figures, cells: int) -> tuple[str, ...]:
    error, ate = ([cell[name][0] for cell in row["cells"].values()] for name in ("filter_error_m", "ate_m"))
    return (
        factor,
        value,
        f"{row['wins']} of {cells}",
        str(row["sure_wins"]),
        str(row["ate_kept"]),
        f"{row['step_ratio_mean']:.2f}",
        f"{sum(error) / len(error):.3f}",
        f"{sum(ate) / len(ate):.3f}",
    )


def _lost(sweep: Figures) -> list[Block]:
    """Return, for each cell that the defaults lose, the smallest changes that win it."""
    items = []
    for cell, changes in sweep["smallest_changes"].items():
        found = []
        if changes["membership"]:
            low, high = crossings(changes["membership"]["position_m"])
            found.append(f"thresholds at {low:.3g} and {high:.3g} m ({_price(changes['membership'])})")
        found += [f"the rules `{row['value']}` ({_price(row)})" for row in changes["rules"]]
        items.append(f"{_cell(cell)}: {'; or '.join(found) if found else 'nothing that was tried wins it'}.")
    if not items:
        return [Text("With the shipped settings no cell is lost on these seeds.")]
    return [
        Heading("What wins the cells that are lost", 3),
        Text(
            "The smallest change of the memberships, and each other rule base, that brings FAMM's filter error below CMM's. They "
            "are variants by name, not the shipped system:"
        ),
        Items(tuple(items)),
    ]


def _resting(sweep: Figures) -> list[Block]:
    """Return what it takes for the stationary dataset to be P0R0 nearly throughout."""
    items = []
    for sensors, change in sweep["resting"].items():
        share = sweep["default"]["cells"][f"3/{sensors}"]["p0r0_share"]
        told = f"{cell_name(3, sensors)}: P0R0 in {100.0 * share:.0f} % of the updates as shipped; "
        if change is None:
            told += "no stretch that was tried reaches 95 %."
        elif change["factor"] == "default":
            told += "nothing need change."
        else:
            reached = change["p0r0_share"][f"3/{sensors}"]
            told += f"the position's breakpoints × {change['value']} bring {100.0 * reached:.0f} % ({_price(change)})."
        items.append(told)
    return [Heading("What it takes to rest", 3), Items(tuple(items))]


def _price(change: Figures) -> str:
    """Say what a variant does to all cells."""
    errors = list(change["filter_error_ratio"].values())
    lost = listed([_cell(cell) for cell in change["lost"]]) if len(change["lost"]) < len(errors) else "all"
    return (
        f"wins {count(change['wins'])} of {count(len(errors))}, loses {lost}; FAMM's filter error is then "
        f"{percent(min(errors))} to {percent(max(errors))} of CMM's, its ATE kept in {count(change['ate_kept'])}"
    )


def _cells(number: int) -> str:
    return f"{count(number)} cell{'' if number == 1 else 's'}"


def _cell(cell: str) -> str:
    dataset, sensors = cell.split("/")
    return cell_name(int(dataset), sensors)
