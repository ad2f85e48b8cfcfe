"""The paper's figures of single walks: paths, orientations, state covariances and filter errors, dataset by dataset."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from server.blocks import Block, Heading, Shown, Text
from server.paper.document.examples import SEED
from server.paper.document.results import SENSORS, Results
from server.plots.angles import angle_caption, angle_figure
from server.plots.covariance import covariance_caption, covariance_figure
from server.plots.innovations import innovation_caption, innovation_figure
from server.plots.paths import path_caption, path_figure
from server.plots.plan import Plan
from server.plots.style import drawn
from server.plots.trace import Array, Trace
from server.tables import PAPER_FOUR

#: Long enough for a glance and a stop, short enough to see a step.
_WINDOW_S = 60.0


def walks(results: Results, examples: Mapping[int, Sequence[Trace]], plan: Plan) -> list[Block]:
    """Return one part for each dataset.

    Args:
        results: For the state covariances, which are means over seeds.
        examples: By dataset, one walk under the paper's four estimators.
        plan: What stands on the site.
    """
    if not examples:
        return []
    blocks: list[Block] = [
        Heading("The five datasets"),
        Text(
            f"One walk of each (seed {SEED}), drawn as the paper draws its own: (a) the truth, (b) and (c) the constant model "
            "without and with the camera, (d) and (e) the fuzzy one. A single walk shows how, not how much; for that, see the "
            "tables over seeds."
        ),
    ]
    for dataset, traces in sorted(examples.items()):
        order = {name: place for place, name in enumerate(PAPER_FOUR)}
        named = [replace(trace, log=f"dataset {dataset}, seed {SEED}") for trace in traces]
        four = sorted(named, key=lambda trace: order[trace.estimator])
        blocks += [Heading(f"Dataset {dataset}", 3), *_walk(results, dataset, four, plan)]
    return blocks


def _walk(results: Results, dataset: int, four: Sequence[Trace], plan: Plan) -> list[Block]:
    path = drawn(path_figure(four, plan), f"path-{dataset}", path_caption(four), "png")
    pair = [trace for trace in four if trace.sensors == SENSORS[-1]] or list(four[:2])
    window = _window(pair[0])
    angles = drawn(angle_figure(pair, window), f"angles-{dataset}", angle_caption(pair, window), "png")
    errors = drawn(innovation_figure(four), f"filter-error-{dataset}", innovation_caption(four), "png")
    blocks: list[Block] = [Shown(path), Shown(angles)]
    sigmas = _sigmas(results, dataset)
    if sigmas:
        caption = covariance_caption(f"dataset {dataset}", sigmas)
        blocks.append(Shown(drawn(covariance_figure(sigmas), f"covariance-{dataset}", caption)))
    return [*blocks, Shown(errors)]


def _window(trace: Trace) -> tuple[float, float] | None:
    """Return a minute from the middle of the walk; None of a walk that is hardly longer."""
    end_s = float(trace.t_s[-1])
    begin_s = round(0.4 * end_s)
    return (begin_s, begin_s + _WINDOW_S) if end_s > 1.5 * _WINDOW_S else None


def _sigmas(results: Results, dataset: int) -> list[tuple[str, Array]]:
    """Return the study's mean state covariances in the paper's order."""
    found = {
        f"{row['sensors']}/{row['model']}": np.array(row["state_covariance"])
        for row in results.sigmas
        if row["dataset"] == dataset
    }
    order = ("gps-imu/cmm", "gps-imu/famm", "camera-gps-imu/cmm", "camera-gps-imu/famm")
    return [(name, found[name]) for name in order if name in found]
