"""The document's summary: what was reproduced, what was not, and what it means for a visitor."""

from math import radians

import numpy as np

from server.blocks import Block, Heading, Items, Text
from server.paper.document import printed
from server.paper.document.own_part import left_of_it
from server.paper.document.results import MOVING, STATIONARY, Results, middle
from server.paper.document.words import cell_name, count, listed, percent, span
from tracker.score import FOCAL_PX

_BEST = ("camera-gps-imu", "famm")
#: A tremble of this many pixels of 1280 is seen at a glance.
_SEEN_PX = 3.0


def opening(results: Results) -> list[Block]:
    """Return the summary."""
    held = [text for text in (_filter_error(results), _truth(results), _camera(results), _drift(results)) if text]
    failed = [
        text for text in (_lost_cells(results), _uncertainty(results), _still(results), _accuracy(results)) if text
    ]
    blocks: list[Block] = [Heading("In short"), Text(_what(results))]
    if held:
        blocks += [Heading("What was reproduced, and what else was found", 3), Items(tuple(held))]
    blocks += [Heading("What could not be reproduced", 3), Items((*failed, *_LOST))]
    visitor = _visitor(results)
    if visitor:
        blocks += [Heading("What it means for a visitor", 3), *(Text(text) for text in visitor)]
    return blocks


_LOST = (
    "The paper's recordings are not public. Its five datasets are simulated here by their printed sizes and descriptions, with "
    "sensor faults of the size of its Phidgets; only the sizes are the same walk.",
    "Its figure of the membership functions is lost, and it prints neither Q nor R. Those used here are ours.",
    "Two of its steps cannot be taken as printed: `Tr` times a position in ECEF turns the visitor about the centre of the Earth, "
    "and four samples of an accelerometer whose mean at rest was subtracted are 16 ms, which move nobody. Both are implemented to "
    "the letter beside the readings that work.",
)


def _what(results: Results) -> str:
    seeds = (
        f"{count(results.seeds)} simulated walks of each of its five datasets" if results.seeds else "simulated walks"
    )
    return (
        f"The [paper]({printed.LINK}) of {printed.AUTHORS} fuses a camera, a GPS receiver and an inertial unit in a Kalman filter "
        "of twelve states whose velocities are switched by 81 fuzzy rules (FAMM), against a constant motion model (CMM). This is "
        f"all of it rebuilt and measured on {seeds}, the same for every variant. Beside the paper's own measure, the "
        "*filter error* (how far each measurement is from its prediction), stands what it lacks: the error against the truth."
    )


def _filter_error(results: Results) -> str:
    rows = results.against("filter_error_m")
    if not rows:
        return ""
    lower = [row for row in rows if row["difference_mean"] < 0.0]
    sure = sum(row["interval_t"][1] < 0.0 for row in rows)
    theirs = sum(errors.famm_m < errors.cmm_m for errors in printed.FILTER_ERRORS.values())
    return (
        f"**FAMM lowers the filter error** in {count(len(lower))} of {count(len(rows))} cells of the paper's two tables, in "
        f"{count(sure)} of them with a 95 % interval that excludes zero; in the paper in {count(theirs)} of ten ([[paired]])."
    )


def _truth(results: Results) -> str:
    ate, jitter = results.against("ate_m"), results.against("jitter_m")
    if not ate or not jitter:
        return ""
    ratios = [row["ratio_median"] for row in ate]
    worst = max(ratios)
    verdict = "not worse than CMM in any cell" if worst <= 1.0 else f"at worst {percent(worst)}"
    return (
        f"**Against the truth the choice of model {_matters(ratios)}.** FAMM's error of position is {span(ratios, 3)} of CMM's "
        f"(median over seeds, cell by cell; {verdict}), while its jitter is {span([row['ratio_median'] for row in jitter], 2)} of "
        "CMM's. A smaller filter error is not a better position: it says that predictions agree with measurements, and both can be "
        "off."
    )


def _matters(ratios: list[float]) -> str:
    off = max(abs(ratio - 1.0) for ratio in ratios)
    return "hardly matters" if off <= 0.02 else "matters little" if off <= 0.1 else "matters"


def _camera(results: Results) -> str:
    ate, rpe = results.camera("ate_m"), results.camera("rpe_10s_m")
    if not ate or not rpe:
        return ""
    better = results.summary["claims"]["camera_better"]
    error = results.camera("filter_error_m")
    higher = sum(row["ratio_median"] > 1.0 for row in error)
    worse = sum(row["ratio_median"] > 1.02 for row in (*ate, *rpe))
    return (
        f"**The camera helps against the truth** in {count(len(better))} of {count(len(ate))} moving cells in both ATE and RPE "
        f"(medians {percent(middle(ate, 'ratio_median') or 1.0)} and {percent(middle(rpe, 'ratio_median') or 1.0)}); worse by "
        f"more than two per cent: {count(worse)} of these {2 * len(ate)} numbers ([[camera]]). The filter error is higher with the "
        f"camera in {count(higher)} of {count(len(error))}; in the paper, in eight of its ten cells."
        + left_of_it(results)
    )


def _drift(results: Results) -> str:
    if not results.attitude:
        return ""
    mean = results.attitude["simulated"]["mean"]
    verdict = "as the paper says" if mean["both"] <= printed.DRIFT_DEG_MIN else "more than the paper says"
    return (
        f"**Calibration at rest** brings the drift of the attitude from {mean['raw']:.1f} to {mean['both']:.2f} degrees a minute, "
        f"{verdict} ({printed.DRIFT_DEG_MIN:g}); the tracker's own, which follows the offset on while it rests, to "
        f"{mean['agora']:.2f} ([[drift]])."
    )


def _lost_cells(results: Results) -> str:
    rows = [row for row in results.against("filter_error_m") if row["difference_mean"] >= 0.0]
    if not rows:
        return ""
    told = [f"{cell_name(row['dataset'], row['sensors'])} ({percent(row['ratio_mean'])})" for row in rows]
    return f"FAMM's filter error is not below CMM's in {listed(told)}."


def _uncertainty(results: Results) -> str:
    """Compare what the filter believes of itself: variances of P and of Omega, FAMM's as multiples of CMM's."""
    sigmas = {
        (row["dataset"], row["sensors"], row["model"]): np.array(row["state_covariance"]) for row in results.sigmas
    }
    pairs = [
        (sigmas[d, s, "famm"], sigma) for (d, s, m), sigma in sigmas.items() if m == "cmm" and (d, s, "famm") in sigmas
    ]
    if not pairs:
        return ""
    totals, places, rates = (
        [float(np.trace(famm[part, part]) / np.trace(cmm[part, part])) for famm, cmm in pairs]
        for part in (slice(0, 12), slice(0, 3), slice(9, 12))
    )
    less = sum(total < 1.0 for total in totals)
    verdict = f"it does so in {count(less)} of {count(len(totals))} cells" if less else "it does so in no cell"
    return (
        f"The paper reads from its maps of the state covariance that FAMM makes the filter surer of itself. Here {verdict}: the "
        f"variances of the position are {span(places, 2)} of CMM's, and those of the angular rate {span(rates, 0)}, because a "
        "model with coefficient 0 takes the coupling out of F, and the filter then learns nothing of a rate."
    )


def _still(results: Results) -> str:
    shares = {
        sensors: cell["p0r0_share"]["mean"]
        for sensors in ("gps-imu", "camera-gps-imu")
        if (cell := results.cell(STATIONARY, sensors, "famm"))
    }
    if not shares:
        return ""
    told = listed(
        [
            f"{100.0 * share:.0f} % {'with' if name.startswith('camera') else 'without'} the camera"
            for name, share in shares.items()
        ]
    )
    return (
        f"The paper's stationary dataset is P0R0 throughout. Here P0R0 is in force in {told} of the updates: one Medium innovation "
        "leaves it, and since Low keeps whatever model there is, nothing leads back but a High one."
    )


def _accuracy(results: Results) -> str:
    runs = results.runs(*_BEST)
    fused, raw = middle(runs, "truth", "ate_rmse_m"), middle(runs, "gps", "ate_rmse_m")
    if fused is None or raw is None:
        return ""
    return (
        f"The paper puts the fused position at about {printed.FUSED_M:g} m, against {printed.GPS_M:g} m for the receiver alone. "
        f"Here it is {fused:.2f} m against {raw:.2f} m, {percent(fused / raw)}: a receiver's error wanders over minutes, and "
        "nothing in a camera or an inertial unit says where the true place is."
    )


def _visitor(results: Results) -> list[str]:
    runs = results.runs(*_BEST, datasets=MOVING)
    keys = ("ate_rmse_m", "heading_rmse_deg", "jitter_rms_m")
    error_m, heading_deg, jitter_m = (middle(runs, "truth", key) for key in keys)
    near_px = middle(runs, "truth", "registration_px", "at_20m", "median")
    far_px = middle(runs, "truth", "registration_px", "at_50m", "median")
    if error_m is None or heading_deg is None or jitter_m is None or near_px is None or far_px is None:
        return []
    near_m, far_m = 20.0 * near_px / FOCAL_PX, 50.0 * far_px / FOCAL_PX
    turned_m = 20.0 * radians(heading_deg)
    cause = "the heading" if turned_m > error_m else "the position"
    return [
        f"A visitor who walks with all three sensors is placed {error_m:.1f} m from where she stands, and her view is turned by "
        f"{heading_deg:.1f} degrees (medians over walks). A column 20 m away is then drawn {near_px:.0f} pixels beside its place "
        f"in a picture 1280 pixels wide, {near_m:.1f} m at its distance; one 50 m away {far_px:.0f} pixels, {far_m:.1f} m. At 20 m "
        f"the larger part is {cause}'s: {turned_m:.1f} m of heading beside {error_m:.1f} m of position.",
        f"{_trembling(jitter_m)} Placing one known corner by hand, or a receiver with corrections, would remove the larger error; "
        "no motion model does.",
    ]


def _trembling(jitter_m: float) -> str:
    px = FOCAL_PX * jitter_m / 20.0
    told = f"{100.0 * jitter_m:.1f} cm, {px:.1f} pixels at 20 m"
    if px < _SEEN_PX:
        return f"The picture hardly trembles ({told}): what is drawn stands still, in a place that is wrong."
    return f"The picture trembles visibly ({told}), which the eye minds more than a place that is wrong."
