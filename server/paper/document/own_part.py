"""What of the camera's gain is the camera's own, and what is averaging that an inertial path can do as well."""

from collections.abc import Iterator

from server.blocks import Block, Grid, Text
from server.paper.document.results import MOVING, SENSORS, Results, middle
from server.paper.document.words import count, percent
from server.paper.statistics import metric, paired
from server.tables import number, once
from tracker.score import Figures

_METRICS = ("ate_m", "rpe_10s_m", "jitter_m", "heading_deg", "filter_error_m")
_MODELS = ("cmm", "famm")


def own_part(results: Results) -> list[Block]:
    """Return the comparison with an inertial unit that is given the same averaging; empty where it was not measured."""
    cells = list(_cells(results))
    if not cells:
        return []
    return [Text(_told(results, cells)), _grid(cells)]


def left_of_it(results: Results) -> str:
    """Return, for the summary, what is left of the camera's gain; empty where it was not measured."""
    cells = list(_cells(results))
    if not cells:
        return ""
    left = {
        name: middle([found[name] for _, _, found in cells], "ratio_median") or 1.0 for name in ("ate_m", "rpe_10s_m")
    }
    heading = middle([found["heading_deg"] for _, _, found in cells if "heading_deg" in found], "ratio_median") or 1.0
    return (
        f" Of this {percent(left['ate_m'])} and {percent(left['rpe_10s_m'])} are the camera's own, and {percent(heading)} of the "
        "heading's error: the rest is an averaging of fixes that the inertial path can do as well ([[camera-own]])."
    )


def _cells(results: Results) -> Iterator[tuple[str, int, dict[str, Figures]]]:
    """Yield every moving cell that was measured both ways: model, dataset, and paired comparisons by figure."""
    held = results.ablation["rows"] if results.ablation else []
    for model in _MODELS:
        for dataset in MOVING:
            theirs = {r["seed"]: r for r in held if (r["dataset"], r["model"]) == (dataset, model)}
            ours = {r["seed"]: r for r in results.runs(SENSORS[1], model, [dataset])}
            seeds = sorted(set(ours) & set(theirs))
            if len(seeds) > 1:
                yield (
                    model,
                    dataset,
                    {name: found for name in _METRICS if (found := _paired(name, ours, theirs, seeds))},
                )


def _paired(name: str, ours: dict[int, Figures], theirs: dict[int, Figures], seeds: list[int]) -> Figures | None:
    a, b = ([metric(rows[seed], name) for seed in seeds] for rows in (ours, theirs))
    known = [(x, y) for x, y in zip(a, b, strict=True) if x is not None and y is not None]
    return paired([x for x, _ in known], [y for _, y in known]) if len(known) > 1 else None


def _told(results: Results, cells: list[tuple[str, int, dict[str, Figures]]]) -> str:
    def change(name: str) -> str:
        whole = middle(results.camera(name), "ratio_median")
        own = middle([found[name] for _, _, found in cells if name in found], "ratio_median")
        return f"{percent(own or 1.0)} (of {percent(whole or 1.0)})"

    better = {
        name: sum(found[name]["ratio_median"] < 1.0 for _, _, found in cells if name in found) for name in _METRICS
    }
    worst = max(found["ate_m"]["ratio_median"] for _, _, found in cells)
    return (
        "Not all of this is the camera's. Its path carries the fixes of ten seconds to one place, where their white error averages "
        "out, and the paper gives GPS and IMU nothing of the kind; the path of the IMU, whose velocity the receiver's Doppler "
        "corrects, can carry them as well (`anchor_imu`). Held against that equal, the medians that remain are "
        f"{change('ate_m')} in ATE, {change('rpe_10s_m')} in RPE and {change('heading_deg')} in heading; the camera is better in "
        f"{count(better['ate_m'])} of {count(len(cells))} moving cells in ATE (at worst {percent(worst)}), in "
        f"{count(better['rpe_10s_m'])} in RPE and in {count(better['heading_deg'])} in heading. What the camera alone can give is "
        "north, and rest: that nothing moves."
    )


def _grid(cells: list[tuple[str, int, dict[str, Figures]]]) -> Grid:
    rows = [
        (
            model.upper(),
            str(dataset),
            *(number(found[name]["ratio_median"] if name in found else None, 3) for name in _METRICS),
        )
        for model, dataset, found in cells
    ]
    caption = (
        "With the camera to without it, where the inertial unit's path carries the fixes to one place as the camera's does. Median "
        "ratios over seeds; below one the camera helps."
    )
    head = ("model", "dataset", "ATE", "RPE 10 s", "jitter", "heading", "filter error")
    return Grid("camera-own", caption, head, once(rows), left=2)
