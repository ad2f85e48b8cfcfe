"""What the study asks of a run, beyond `tracker.evaluate`: one flat row, None where a figure means nothing."""

from dataclasses import dataclass

import numpy as np

from tests.benchmarks.accuracy.entrants import AHEAD_NS, RAW, Watched
from tests.benchmarks.accuracy.scenarios import DISTURBED_FROM_S, SPELL_S
from tests.benchmarks.accuracy.world import WALKING_M_S, Recording
from tracker import score
from tracker.evaluate import Run, figures
from tracker.measurements import TruePose
from tracker.score import SETTLING_S, Figures, Track, Vector

#: Slower than this, for a second before and after, is standing.
STANDING_M_S, AROUND_S = 0.1, 1.0
WINDOW_S = 90.0
WALKED_S, WALKED_M = 30.0, 20.0
#: A disturbed heading is compared with that of the seconds before, until so long after.
BEFORE_S, AFTER_S = 10.0, 5.0
TOLD_S = 60.0
#: Rivals that tell attitude alone, and no north: six axes.
ATTITUDE_ONLY = ("vqf", "imufusion")
#: What the raw receiver does not tell.
ATTITUDE_FIGURES = (
    "heading_deg",
    "heading_walked_deg",
    "heading_20m_deg",
    "tilt_deg",
    "excursion_deg",
    "jitter_deg",
    "px_20m",
    "nees_heading",
)


@dataclass(frozen=True, eq=False)
class Compared:
    """A run beside the truth: rows at the ticks where both are known."""

    t_s: Vector
    """(n,) since the start."""
    estimate: Track
    truth: Track
    error_m: Vector
    """(n, 3)"""
    heading_rad: Vector
    tilt_rad: Vector
    speed_m_s: Vector
    """(n,) true, over the ground."""
    walked_s: Vector
    """(n,) of true walking, since the start."""
    walked_m: Vector


def compared(run: Run) -> Compared:
    """Return a run beside its truth, whose map frame is the site's."""
    estimate = score.track(run.poses)
    truth, known = score.true_track(run.truth, np.eye(4), estimate.t_ns)
    estimate, truth = estimate.at(known), truth.at(known)
    t_s = np.asarray((estimate.t_ns - run.t_start_ns) * 1e-9, np.float64)
    turn = score.turns(estimate.wxyz, truth.wxyz)
    true_s, speed, walked_s, walked_m = _walked(run.truth, run.t_start_ns)
    return Compared(
        t_s,
        estimate,
        truth,
        estimate.p_m - truth.p_m,
        score.heading_rad(turn),
        score.tilt_rad(turn),
        *(np.interp(t_s, true_s, values) for values in (speed, walked_s, walked_m)),
    )


def _walked(truth: list[TruePose], start_ns: int) -> tuple[Vector, Vector, Vector, Vector]:
    """Return instants, speed over the ground, and time and way of walking so far, each (m,)."""
    t_s = np.array([pose.t_ns - start_ns for pose in truth]) * 1e-9
    speed = np.array([np.hypot(*pose.v_map_m_s[:2]) for pose in truth if pose.v_map_m_s is not None])
    step_s = np.diff(t_s, prepend=t_s[0]) * (speed > WALKING_M_S)
    return t_s, speed, np.cumsum(step_s), np.cumsum(step_s * speed)


def row_of(recording: Recording, watched: Watched) -> Figures:
    """Return a run as a row."""
    run = watched.run
    row: Figures = {"scenario": recording.scenario.name, "seed": recording.seed, "estimator": run.estimator}
    usual = figures(run)
    if usual["truth"] is None:
        return row | {"raw_m": usual["gps"]["ate_rmse_m"]}
    row |= {"raw_m": usual["gps"]["ate_rmse_m"], **_usual(usual)}
    at = compared(run)
    row |= _windows(at) | _headings(at) | _jitter(at) | _prediction(at, watched) | {"cpu_us": watched.cpu_us}
    row |= _outage(at, recording.outage_s)
    row |= _excursion(at) if recording.scenario.disturbance else {"excursion_deg": None}
    row |= _told(at, recording.told_ns, run.t_start_ns)
    return _meant(row)


def _usual(usual: Figures) -> Figures:
    truth = usual["truth"]
    return {
        "ate_m": truth["ate_rmse_m"],
        "ate_ratio": truth["ate_rmse_m"] / usual["gps"]["ate_rmse_m"],
        "debiased_m": truth["ate_debiased_rmse_m"],
        "rpe_10s_m": truth["rpe_10s_m"],
        "height_m": truth["height_rmse_m"],
        "heading_deg": truth["heading_rmse_deg"],
        "tilt_deg": truth["tilt_rmse_deg"],
        "jitter_deg": truth["jitter_rms_deg"],
        "px_20m": truth["registration_px"]["at_20m"]["median"],
        "nees_position": truth["nees_per_dim"],
        "nees_heading": truth["nees_heading"],
    }


def _meant(row: Figures) -> Figures:
    """Return a row without what its estimator does not tell."""
    name, always = row["estimator"], ("scenario", "seed", "estimator", "raw_m", "cpu_us")
    if name == RAW:
        return {key: None if key in ATTITUDE_FIGURES else value for key, value in row.items()}
    if name in ATTITUDE_ONLY:
        return {key: value if key in (*always, "tilt_deg") else None for key, value in row.items()}
    return row


def _windows(at: Compared) -> Figures:
    """The mean over windows of the RMSE without each window's mean error."""
    found = []
    for begin_s in np.arange(SETTLING_S, at.t_s[-1] - WINDOW_S + 0.1, WINDOW_S):
        error = at.error_m[(at.t_s >= begin_s) & (at.t_s < begin_s + WINDOW_S)]
        if len(error):
            found.append(score.ate_rmse_m(error - error.mean(axis=0)))
    return {"debiased_90s_m": float(np.mean(found)) if found else None}


def _headings(at: Compared) -> Figures:
    late = at.heading_rad[at.walked_s >= WALKED_S]
    far = np.flatnonzero(at.walked_m >= WALKED_M)
    return {
        "heading_walked_deg": float(np.degrees(np.sqrt(np.mean(np.square(late))))) if len(late) else None,
        "heading_20m_deg": float(np.degrees(abs(at.heading_rad[far[0]]))) if len(far) else None,
    }


def _jitter(at: Compared) -> Figures:
    settled = at.t_s >= SETTLING_S
    fast, told = score.fast_part(at.estimate.t_ns[settled], at.error_m[settled])
    length, speed = np.linalg.norm(fast, axis=1), at.speed_m_s[settled]
    reach = round(AROUND_S * score.RATE_HZ)
    moves = np.convolve(speed > STANDING_M_S, np.ones(2 * reach + 1), "same") > 0.5
    figures: Figures = {}
    for name, use in (("walking", speed > WALKING_M_S), ("standing", ~moves)):
        use = use & told
        figures[f"jitter_{name}_m"] = float(np.sqrt(np.mean(np.square(length[use])))) if np.any(use) else None
    return figures


def _prediction(at: Compared, watched: Watched) -> Figures:
    """Rotation error of what was foreseen, all of it, and the part that 50 ms ahead have added to it."""
    if not watched.ahead:
        return {"prediction_deg": None, "prediction_added_deg": None}
    ahead = score.track(watched.ahead)
    truth, known = score.true_track(watched.run.truth, np.eye(4), ahead.t_ns)
    use = known & (ahead.t_ns - watched.run.t_start_ns >= SETTLING_S * 1e9)
    wrong = score.turns(ahead.wxyz[use], truth.wxyz[use])
    now = np.searchsorted(at.estimate.t_ns, ahead.t_ns[use] - AHEAD_NS)
    wrong_now = score.turns(at.estimate.wxyz[now], at.truth.wxyz[now])
    added = score.turns(wrong, wrong_now)
    return {"prediction_deg": _rms_deg(wrong), "prediction_added_deg": _rms_deg(added)}


def _rms_deg(turn: Vector) -> float:
    angle = 2.0 * np.arccos(np.clip(np.abs(turn[:, 0]), 0.0, 1.0))
    return float(np.degrees(np.sqrt(np.mean(np.square(angle)))))


def _outage(at: Compared, outage_s: tuple[float, float] | None) -> Figures:
    """The horizontal error at an outage's end, and how far it has moved since its beginning."""
    if outage_s is None or at.t_s[0] > outage_s[0]:
        return {"outage_end_m": None, "outage_added_m": None}
    began, ended = (at.error_m[int(np.searchsorted(at.t_s, t)), :2] for t in outage_s)
    return {"outage_end_m": float(np.hypot(*ended)), "outage_added_m": float(np.hypot(*(ended - began)))}


def _excursion(at: Compared) -> Figures:
    """The furthest that heading goes from where it was, while the field is disturbed and just after."""
    begin_s, end_s = DISTURBED_FROM_S, DISTURBED_FROM_S + SPELL_S + AFTER_S
    before = (at.t_s >= begin_s - BEFORE_S) & (at.t_s < begin_s)
    during = (at.t_s >= begin_s) & (at.t_s < end_s)
    off = at.heading_rad[during] - np.median(at.heading_rad[before])
    return {"excursion_deg": float(np.degrees(np.max(np.abs((off + np.pi) % (2 * np.pi) - np.pi))))}


def _told(at: Compared, told_ns: list[int], start_ns: int) -> Figures:
    """The minute after the last of what was pointed out."""
    names = ("told_m", "told_heading_deg", "told_px")
    if not told_ns:
        return dict.fromkeys(names)
    begin_s = (max(told_ns) - start_ns) * 1e-9
    use = (at.t_s >= begin_s) & (at.t_s < begin_s + TOLD_S)
    px = score.registration_px(at.estimate.at(use), at.truth.at(use))["at_20m"]["median"]
    heading = float(np.degrees(np.sqrt(np.mean(np.square(at.heading_rad[use])))))
    return dict(zip(names, (score.ate_rmse_m(at.error_m[use]), heading, px), strict=True))
