"""What the paper's tables lack: every cell against the truth, with the rivals, the camera's part, and the loop."""

from server.blocks import Block, Grid, Heading, Shown, Text
from server.paper.document.own_part import own_part
from server.paper.document.results import SENSORS, STATIONARY, Results, middle
from server.paper.document.words import listed, percent
from server.plots.comparison import camera_caption, camera_figure, rivals_caption, rivals_figure
from server.plots.style import drawn
from server.tables import number, once
from tracker.score import Figures


def against_truth(results: Results) -> list[Block]:
    """Return the section; empty without a study."""
    if not results.rows:
        return []
    against = [row for row in results.summary["against_cmm"] if row["model"] != "cmm"]
    camera = results.summary["camera"]
    blocks: list[Block] = [
        Heading("Against the truth"),
        Text(
            "The paper shows its truth as a drawing. A filter error says how well a filter agrees with what it is fed; the tables "
            "here say where the visitor was. Each number is the median over seeds."
        ),
        _table(results),
        Shown(drawn(rivals_figure(against), "rivals", rivals_caption(against))),
    ]
    if camera:
        blocks += [
            Heading("What the camera adds", 3),
            Shown(drawn(camera_figure(camera), "camera", camera_caption(camera))),
        ]
        blocks += [_camera_grid(results), *own_part(results)]
    return [*blocks, *_loop(results), *_still(results)]


def _table(results: Results) -> Grid:
    rows = []
    for dataset in range(1, 6):
        for sensors in SENSORS:
            models = dict.fromkeys(row["model"] for row in results.rows)
            for model in models:
                cell, runs = results.cell(dataset, sensors, model), results.runs(sensors, model, [dataset])
                if cell is not None and runs:
                    rows.append((str(dataset), f"{sensors}/{model}", *_values(cell, runs)))
    caption = (
        "Every cell against the truth. The receiver's own error, horizontal root mean squares of position (ATE) and of its change "
        "over ten seconds (RPE), heading, the part of the error above 1 Hz (jitter), squared error over promised variance for "
        "each dimension (NEES: 1 is honest), and how far an object 20 m ahead is drawn from its place (1280 pixels, 60 degrees)."
    )
    head = (
        "dataset",
        "estimator",
        "raw GPS, m",
        "ATE, m",
        "RPE 10 s, m",
        "heading, °",
        "jitter, cm",
        "NEES",
        "px at 20 m",
    )
    return Grid("truth", caption, head, once(rows), left=2)


def _values(cell: Figures, runs: list[Figures]) -> tuple[str, ...]:
    def median(name: str, decimals: int, scale: float = 1.0) -> str:
        spread = cell.get(name)
        return number(None if spread is None else spread["median"] * scale, decimals)

    return (
        median("raw_gps_m", 2),
        median("ate_m", 3),
        median("rpe_10s_m", 3),
        median("heading_deg", 2),
        median("jitter_m", 1, 100.0),
        median("nees_position", 2),
        number(middle(runs, "truth", "registration_px", "at_20m", "median"), 0),
    )


def _camera_grid(results: Results) -> Grid:
    rows = []
    metrics = ("ate_m", "rpe_10s_m", "jitter_m", "heading_deg", "filter_error_m")
    by_metric = {m: {(r["model"], r["dataset"]): r for r in results.camera(m)} for m in metrics}
    for model, dataset in by_metric["ate_m"]:
        ratios = [by_metric[metric].get((model, dataset)) for metric in metrics]
        rows.append((model.upper(), str(dataset), *(number(r["ratio_median"] if r else None, 3) for r in ratios)))
    caption = (
        "With the camera to without it. Median ratios over seeds of the moving datasets; below one the camera helps."
    )
    head = ("model", "dataset", "ATE", "RPE 10 s", "jitter", "heading", "filter error")
    return Grid("camera-ratios", caption, head, once(rows), left=2)


def _loop(results: Results) -> list[Block]:
    closures = results.summary["claims"].get("loop_closure_m") or {}
    if not closures:
        return []
    told = listed([f"{value:.2f} m ({name})" for name, value in sorted(closures.items(), key=lambda entry: entry[1])])
    return [
        Heading("Closing the loop", 3),
        Text(
            f"Dataset 5 ends where it began. Its two ends lie apart by {told}, medians over seeds. The receiver's error at two "
            "times minutes apart is independent, so no filter of these sensors can close the loop better than two fixes differ; "
            "only recognising the place would."
        ),
    ]


def _still(results: Results) -> list[Block]:
    cells = [(s, m, results.cell(STATIONARY, s, m)) for s in SENSORS for m in ("cmm", "famm")]
    known = [(s, m, cell) for s, m, cell in cells if cell is not None and cell["ate_m"] is not None]
    if len(known) < len(cells):
        return []
    told = [f"{cell['ate_m']['median']:.2f} m ({s}/{m})" for s, m, cell in known]
    raw = known[0][2]["raw_gps_m"]["median"]
    best = min(cell["ate_m"]["median"] for _, _, cell in known)
    return [
        Heading("Standing still", 3),
        Text(
            f"On dataset 3 nobody moves; the receiver alone is off by {raw:.2f} m and the filters by {listed(told)}, at best "
            f"{percent(best / raw)}. Averaging helps against the white part of its error and not against the part that wanders."
        ),
    ]
