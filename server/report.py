"""`agora evaluate --report DIR`: any logs and estimators as one page of tables and figures, and the figures as files."""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from assets.site import Site
from server.blocks import Block, Document, Grid, Heading, Items, Shown, Text
from server.evaluation import Evaluation
from server.page import html
from server.plots.angles import angle_caption, angle_figure
from server.plots.covariance import covariance_caption, covariance_figure
from server.plots.innovations import innovation_caption, innovation_figure
from server.plots.paths import path_caption, path_figure
from server.plots.plan import Plan, plan_of
from server.plots.style import Kind, Picture, drawn
from server.plots.trace import Trace
from server.tables import PAPER_FOUR, filter_error_grid, share_grid, truth_grid, without_filter_error
from tracker.errors import InputError

#: Above this length line art is a picture of pixels: a walk of a quarter of an hour has thousands of strokes.
_LONGEST_SVG_S = 60.0
#: Panels of one path figure.
_MOST_PATHS = 6


def report_of(evaluation: Evaluation, traces: Sequence[Trace], site: Site | None = None) -> Document:
    """Return the report on an evaluation.

    Args:
        evaluation: Its rows.
        traces: One for each run, in any order.
        site: Whose plan is laid under the paths of what was walked there.
    """
    logs = list(dict.fromkeys(row["log"] for row in evaluation.runs))
    estimators = list(dict.fromkeys(row["estimator"] for row in evaluation.runs))
    lead = (
        f"What {_listed(estimators)} made of {_listed(logs)}: the filter's error against its own measurements, as in the paper, "
        "and the error against truth where there is one."
    )
    blocks: list[Block] = [Heading("Tables"), *_grids(evaluation)]
    if evaluation.settings:
        changed = ", ".join(f"`{key} = {value}`" for key, value in evaluation.settings.items())
        blocks.insert(0, Text(f"Settings that were not the defaults: {changed}."))
    for log in logs:
        blocks.append(Heading(log))
        blocks += _log(log, [trace for trace in traces if trace.log == log], site)
    if evaluation.missing:
        blocks.append(Heading("What could not be run"))
        blocks.append(Items(tuple(f"{m['log']}: `{m['estimator']}`, {m['missing']}." for m in evaluation.missing)))
    return Document("Agora: evaluation", lead, tuple(blocks))


def write_report(document: Document, folder: Path) -> Path:
    """Write index.html and the figures as files beside it; return the page.

    Raises:
        InputError: The folder cannot be written to.
    """
    page = folder / "index.html"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        page.write_text(html(document), encoding="utf-8")
        for picture in document.pictures():
            (folder / f"{picture.name}.{picture.kind}").write_bytes(picture.data)
    except OSError as error:
        raise InputError(f"{folder} cannot be written to: {error.strerror}.") from error
    return page


def run_pictures(traces: Sequence[Trace], plan: Plan, slug: str) -> Iterator[Picture]:
    """Yield the paper's figures of one log: paths, orientation, state covariances, filter error."""
    for number, part in enumerate(_path_groups(traces)):
        name = f"path-{slug}" if number == 0 else f"path-{slug}-{number + 1}"
        yield drawn(path_figure(part, plan), name, path_caption(part), _kind(traces))
    pair = [trace for trace in _paper_first(traces) if trace.sensors == _fullest(traces)][:2] or list(traces[:2])
    yield drawn(angle_figure(pair), f"angles-{slug}", angle_caption(pair), _kind(traces))
    four = [trace for trace in _paper_first(traces) if trace.state_covariance.size][:4]
    if four:
        sigmas = [(trace.estimator, trace.state_covariance) for trace in four]
        subject = traces[0].log
        yield drawn(covariance_figure(sigmas), f"covariance-{slug}", covariance_caption(subject, sigmas))
    errors = [trace for trace in _paper_first(traces) if len(trace.update_m)]
    errors = [trace for trace in errors if trace.estimator in PAPER_FOUR] or errors
    if errors:
        yield drawn(innovation_figure(errors), f"filter-error-{slug}", innovation_caption(errors), _kind(traces))


def slug_of(log: str) -> str:
    """Return a log's name as a file may be named and a link may say it."""
    return re.sub(r"[^a-z0-9]+", "-", log.lower()).strip("-") or "log"


def _grids(evaluation: Evaluation) -> list[Block]:
    grids: list[Grid | None] = [
        filter_error_grid(evaluation.runs, "gps-imu", "filter-error-gps-imu"),
        filter_error_grid(evaluation.runs, "camera-gps-imu", "filter-error-camera-gps-imu"),
        truth_grid(evaluation.runs, "truth"),
        share_grid(evaluation.runs, "models"),
    ]
    found: list[Block] = [grid for grid in grids if grid is not None]
    if (reason := without_filter_error(evaluation.runs)) is not None:
        found.insert(0, Text(reason))
    return found or [Text("No run had a filter or a truth to compare with.")]


def _log(log: str, traces: Sequence[Trace], site: Site | None) -> list[Block]:
    seen = [trace for trace in traces if len(trace.t_s)]
    if not seen:
        return [Text("No estimator gave a pose.")]
    drawable = [trace for trace in seen if trace.selector != "truth"] or seen
    plan = plan_of(site, drawable[0].origin) if site else ()
    return [Shown(picture) for picture in run_pictures(drawable, plan, slug_of(log))]


def _paper_first(traces: Sequence[Trace]) -> list[Trace]:
    """Return the paper's four in its order, then the others."""
    order = {name: place for place, name in enumerate(PAPER_FOUR)}
    return sorted(traces, key=lambda trace: order.get(trace.estimator, len(order)))


def _path_groups(traces: Sequence[Trace]) -> list[list[Trace]]:
    """Return the paper's four together, then the rivals in figures that are not too full."""
    four = [trace for trace in _paper_first(traces) if trace.estimator in PAPER_FOUR]
    rivals = [trace for trace in traces if trace.estimator not in PAPER_FOUR]
    groups = [rivals[place : place + _MOST_PATHS] for place in range(0, len(rivals), _MOST_PATHS)]
    return [four, *groups] if four else groups


def _fullest(traces: Sequence[Trace]) -> str:
    return max((trace.sensors for trace in traces), key=len)


def _kind(traces: Sequence[Trace]) -> Kind:
    return "svg" if max(float(trace.t_s[-1]) for trace in traces) <= _LONGEST_SVG_S else "png"


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
