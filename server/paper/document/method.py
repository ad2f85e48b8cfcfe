"""How it was measured: the walks, how the paper is read where it leaves a choice, and where each of its parts is in the code."""

from server.blocks import Block, Grid, Heading, Items, Text
from server.paper.document.results import Results
from server.paper.document.words import percent
from server.paper.parts import PARTS
from server.settings import all_settings
from server.tables import number, once
from tracker.choreography import DATASET_DURATION_S, DATASET_UPDATES
from tracker.score import Figures
from tracker.simulate import SensorNoise

_WALKS = {
    1: "a long mixed visit: walking, stopping, looking round",
    2: "a shorter one with fewer stops",
    3: "completely stationary",
    4: "a shorter one with many stops and glances",
    5: "a loop that closes",
}


def method(results: Results) -> list[Block]:
    """Return the section on method."""
    return [Heading("Method"), *_walks(results), *_agreement(results), *_readings(results), *_parts()]


def _walks(results: Results) -> list[Block]:
    noise = SensorNoise()
    rows = tuple(
        (str(d), words, str(DATASET_UPDATES[d]), f"{DATASET_DURATION_S[d]:.0f}") for d, words in sorted(_WALKS.items())
    )
    study = (
        f"Everything over seeds is measured on seeds {min(results.study['seeds'])} to {max(results.study['seeds'])} of each "
        "dataset; "
        if results.study
        else ""
    )
    return [
        Heading("The walks", 3),
        Grid("walks", "The five datasets. Sizes are the paper's, four updates a second.", _WALK_HEAD, rows, left=2),
        Text(
            "A simulated visitor walks on the ground model of the State Agora of Ephesus with a head that bobs, sways and looks "
            "about. The inertial unit gives 250 samples a second with the white noise, offset and drift of a Phidget; the receiver "
            f"one fix a second, whose error wanders ({noise.gps_slow_m[0]:g} m over {noise.gps_slow_s:g} s) under a white part "
            f"({noise.gps_white_m[0]:g} m); the camera up to four keyframes a second. {study}one seed, one walk, one set of "
            "sensor faults, seen alike by every variant: differences are paired, and intervals are those of paired differences."
            if study
            else "A simulated visitor walks on the ground model of the State Agora of Ephesus."
        ),
        Text(
            "Rendering every picture of every walk would take days. Figures over seeds use a *feature camera*: textured points of "
            "the same world, projected with pixel noise, outliers, occlusion and lifetimes as measured on rendered pictures, which "
            "feed the real keyframe, essential-matrix and filter code. Everything is measured against the simulator's truth, "
            "without any alignment, from 20 s into each walk on."
        ),
    ]


def _agreement(results: Results) -> list[Block]:
    """Return how near the feature camera is to drawn pictures; empty where that was not measured."""
    walks = results.feature["walks"] if results.feature else []
    names = [f"camera-gps-imu/{model}: {what}" for what in ("filter error m", "ATE m") for model in ("cmm", "famm")]
    rows = [
        (str(walk["dataset"]), str(walk["seed"]), *(number(walk["features"][n] / walk["drawn"][n], 3) for n in names))
        for walk in walks
    ]
    if not rows:
        return []
    worst = max(abs(walk["features"][n] / walk["drawn"][n] - 1.0) for walk in walks for n in names)
    caption = (
        f"The feature camera beside rendered pictures, as ratios of what the filter makes of both; they differ by "
        f"{100.0 * worst:.1f} % at most. `python -m server.feature_measure` compares them on any rendered walk."
    )
    head = ("dataset", "seed", "filter error, CMM", "filter error, FAMM", "ATE, CMM", "ATE, FAMM")
    return [Grid("feature", caption, head, tuple(rows), left=1)]


_WALK_HEAD = ("dataset", "walk", "updates", "seconds")

_READINGS = (
    "`m_P = keyframe_local` (default): the camera's displacement since the keyframe nearest to the fix is added to the fix, and "
    "`m_imu` is what was walked since. `literal_enu` and `literal_ecef` multiply the position by the whole of `Tr`, as eq. 8 is "
    "printed: the rotation of the head then turns the visitor about the site's origin, or about the centre of the Earth.",
    "`m_imu = sane` (default): accelerations are turned into the site's axes, gravity is removed, and the integral starts anew "
    "at each fix. `literal` subtracts the mean at rest (gravity included, for one attitude) and integrates four samples: 16 ms, "
    "micrometres.",
    "`innovation = metres` (default): the controller is given the size of the innovation in metres and radians. `nis` divides it "
    "by what the filter expected, so that Low, Medium and High are in standard deviations.",
    "The constant model is P1R1, as the paper says of its figures; the fuzzy one begins at P0R0, since a rig rests for its "
    "calibration and Low keeps whatever there is.",
)


def _readings(results: Results) -> list[Block]:
    blocks: list[Block] = [
        Heading("How the paper is read", 3),
        Text("Where its text is ambiguous, or fails as printed, both readings are there, chosen by `--set`:"),
        Items(_READINGS),
    ]
    if results.readings:
        blocks.append(_reading_grid(results.readings))
    settings = tuple((f"`{s.key}`", f"`{s.text}`", s.meaning) for s in all_settings() if s.key.startswith("paper."))
    blocks += [
        Text(
            "These are all the choices that the paper leaves open, with the value that every figure here was made with:"
        ),
        Grid(
            "settings",
            "Settings and their defaults. `agora settings` prints this list.",
            _SETTING_HEAD,
            settings,
            left=3,
        ),
    ]
    return blocks


_SETTING_HEAD = ("setting", "default", "meaning")


def _reading_grid(readings: Figures) -> Grid:
    """Return what each reading does to the result, beside the default's."""
    rows = []
    for row in readings["rows"]:
        truth = row["truth"] or {}
        base = next(r for r in readings["rows"] if r["sensors"] == row["sensors"] and not r["changes"])
        error, usual = row["filter_error_m"]["mean"], base["filter_error_m"]["mean"]
        rows.append(
            (
                row["sensors"],
                ", ".join(f"`{change}`" for change in row["changes"]) or "defaults",
                _size(error),
                percent(error / usual) if error < 10.0 * usual else f"× {error / usual:.2g}",
                _size(truth.get("ate_rmse_m")),
                _size(truth.get("rpe_10s_m")),
                number(100.0 * row["motion_model_share"].get("P0R0", 0.0), 0),
            )
        )
    caption = (
        f"What each reading does to FAMM on dataset {readings['dataset']}, seed {readings['seed']}. The literal ones are here to "
        "be seen, not to be used; with `nis` the breakpoints of the memberships are read as standard deviations. The last two rows "
        "take away what is ours and not the paper's: with `anchor_s = 0.1` only the last fix counts, where otherwise the camera's "
        "path carries those of ten seconds to one place and their white error averages out; with `camera_north = false` north "
        "stays where the start heading and the gyroscope have it."
    )
    head = ("sensors", "reading", "filter error, m", "change", "ATE, m", "RPE 10 s, m", "P0R0, %")
    return Grid("readings", caption, head, once(rows), left=2)


def _size(value: float | None) -> str:
    """Return metres; the Earth's radius is no number for two decimals."""
    return number(value, 3) if value is None or value < 1000.0 else f"{value:.2g}"


def _parts() -> list[Block]:
    """Return the table of the paper's parts, which a test walks."""
    rows = tuple((part.name, f"`{part.where}`", f"`{part.test}`") for part in PARTS)
    caption = (
        "Every part of the paper, where it is in the code, and a test that fails when it is wrong. Equations are counted as the "
        "paper numbers them. The docstring at each place cites the part; a test walks this table."
    )
    return [Heading("The parts", 3), Grid("parts", caption, ("part of the paper", "code", "test"), rows, left=3)]
