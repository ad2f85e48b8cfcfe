"""The paper's two tables of filter errors over seeds, its own numbers beside them, and every cell compared."""

from server.blocks import Block, Grid, Heading, Shown, Text
from server.paper.document.printed import FILTER_ERRORS
from server.paper.document.results import SENSORS, Results
from server.paper.document.words import cell_name, count, listed
from server.plots.comparison import paired_caption, paired_figure
from server.plots.style import drawn
from server.tables import arrow, once
from tracker.choreography import DATASET_UPDATES

_TITLES = {
    "gps-imu": "Mean and standard deviation of the filter error for the integration of GPS and IMU",
    "camera-gps-imu": "Mean and standard deviation of the filter error for the integration of camera, GPS and IMU",
}


def errors(results: Results) -> list[Block]:
    """Return the section on the filter error."""
    rows = results.against("filter_error_m")
    if not rows:
        return [Heading("The filter error"), Text("Not measured: `python -m server.paper` runs the study.")]
    changes = {key: printed.change_percent for key, printed in FILTER_ERRORS.items()}
    return [
        Heading("The filter error"),
        Text(
            "The paper's measure: the distance between each measured position and the filter's prediction of it. Both tables keep "
            "its layout; the arrow tells which way the mean went when FAMM was employed. Beneath each of our rows stands the "
            "paper's, of another walk of the same size."
        ),
        *(_table(results, sensors) for sensors in SENSORS),
        Shown(drawn(paired_figure(rows, changes), "paired", paired_caption(rows))),
        _compared(results),
        Text(_why(results)),
    ]


def _table(results: Results, sensors: str) -> Grid:
    rows: list[tuple[str, ...]] = []
    for dataset, size in DATASET_UPDATES.items():
        runs = {model: results.runs(sensors, model, [dataset]) for model in ("cmm", "famm")}
        if not all(runs.values()):
            continue
        means = {
            model: [_mean([run["filter_error_m"][key] for run in found]) for key in ("mean", "std")]
            for model, found in runs.items()
        }
        ours = (*means["cmm"], *means["famm"])
        theirs = FILTER_ERRORS[dataset, sensors]
        rows.append((str(dataset), str(size), "here", *(f"{value:.4f}" for value in ours), arrow(ours[0], ours[2])))
        values = (theirs.cmm_m, theirs.cmm_std_m, theirs.famm_m, theirs.famm_std_m)
        rows.append(
            (str(dataset), "", "paper", *(f"{value:.4f}" for value in values), arrow(theirs.cmm_m, theirs.famm_m))
        )
    head = ("dataset", "size", "", "CMM mean", "CMM std", "FAMM mean", "FAMM std", "")
    caption = f"{_TITLES[sensors]}. Metres; ours are means over {results.seeds} seeds."
    return Grid(f"errors-{sensors}", caption, head, once(rows))


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


def _compared(results: Results) -> Grid:
    angles = {(row["dataset"], row["sensors"]): row for row in results.against("filter_error_rad")}
    rows = []
    for row in results.against("filter_error_m"):
        low, high = (100.0 * end for end in row["interval_t"])
        angle = angles.get((row["dataset"], row["sensors"]))
        rows.append(
            (
                row["sensors"],
                str(row["dataset"]),
                f"{100.0 * row['difference_mean']:+.2f}",
                f"{low:+.2f} to {high:+.2f}",
                f"{row['ratio_median']:.3f}",
                f"{row['wins']} of {row['n']}",
                f"{angle['ratio_median']:.3f}" if angle else "–",
            )
        )
    caption = (
        "FAMM against CMM, seed by seed. Mean difference of the filter error in centimetres with its 95 % interval (Student), the "
        "median ratio, the seeds that FAMM wins, and the median ratio of the rotational filter error."
    )
    head = ("sensors", "dataset", "difference, cm", "95 % interval", "ratio", "FAMM wins", "ratio, rotation")
    return Grid("compared", caption, head, once(rows), left=2)


def _why(results: Results) -> str:
    rows = results.against("filter_error_m")
    lost = [cell_name(row["dataset"], row["sensors"]) for row in rows if row["difference_mean"] >= 0.0]
    why = (
        "A smaller filter error is bought by gain: what makes the filter follow its measurements more closely makes the next one "
        "less of a surprise. P2 does that by doubling a velocity that the measurement then corrects; P0 does the opposite, since a "
        "position without a velocity follows a moving measurement late."
    )
    if not lost:
        return f"FAMM wins all {count(len(rows))} cells. {why}"
    return f"FAMM does not win {listed(lost)}. {why}"
