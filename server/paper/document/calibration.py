"""Calibration at rest, attitude against its rivals, and the camera's rotation against the gyroscope's."""

from server.blocks import Block, Grid, Heading, Shown, Text
from server.paper.document.printed import DRIFT_DEG_MIN
from server.paper.document.results import Results
from server.paper.document.words import listed
from server.plots.drift import WAYS, drift_caption, drift_figure
from server.plots.style import drawn
from server.tables import DASH, number, once
from tracker.score import Figures

_AXES = ("x", "y", "z")
#: The project's own goal for the median difference of camera and gyroscope.
_AGREE_DEG = 0.5


def calibration(results: Results) -> list[Block]:
    """Return the section; empty where nothing was measured."""
    measured = results.attitude
    if measured is None:
        return [
            Heading("Calibration at rest"),
            Text("Not measured: `python -m server.paper.attitude` writes its figures."),
        ]
    seeds = [seed["drift_deg_min"] for seed in measured["simulated"]["seeds"]]
    blocks: list[Block] = [
        Heading("Calibration at rest"),
        _offsets(measured),
        Text(
            "The paper subtracts the accelerometer's mean too. That mean holds gravity and the tilt of the table, so taking it "
            "away is right for one attitude only; here the gyroscope's offset alone is removed, and the table is for show."
        ),
        Shown(drawn(drift_figure(seeds, DRIFT_DEG_MIN), "drift", drift_caption(seeds, DRIFT_DEG_MIN))),
    ]
    recorded = measured.get("recorded") or []
    if recorded:
        blocks += _recorded(recorded)
    camera = measured.get("camera")
    return blocks + (_camera(camera) if camera else [])


def _offsets(measured: Figures) -> Grid:
    def row(name: str, source: Figures) -> list[tuple[str, ...]]:
        return [
            (f"{name}, accelerometer, g", *(f"{value:.6f}" for value in source["accel_g"])),
            (f"{name}, gyroscope, °/s", *(f"{value:.6f}" for value in source["gyro_deg_s"])),
        ]

    rows = row("the paper", measured["paper"])
    for log in measured.get("recorded") or []:
        if log["offsets"]:
            rows += row(log["log"], log["offsets"])
    first = measured["simulated"]["seeds"][0]
    rows += row(f"simulated, seed {first['seed']}", first["offsets"])
    caption = "Calibration parameters found for accelerometer and gyroscope. The mean of about 5000 samples at rest, as there."
    return Grid("offsets", caption, ("", *_AXES), tuple(rows))


def _recorded(logs: list[Figures]) -> list[Block]:
    ways = [way for way in WAYS if any(way in log["error_deg"] for log in logs)]
    still = [(log["log"], rest) for log in logs for rest in log["rests"]]
    blocks: list[Block] = [Heading("On recordings", 3)]
    if still:
        rows = tuple(
            (
                name,
                f"{rest['from_s']:.0f} to {rest['to_s']:.0f}",
                *(number(rest["drift_deg_min"].get(w), 2) for w in ways),
            )
            for name, rest in still
        )
        caption = "Drift at rest on recordings. Degrees a minute in every rest after the calibration."
        head = ("log", "rest, s", *(WAYS[way] for way in ways))
        blocks.append(Grid("recorded-drift", caption, head, once(rows), left=2))
    errors = tuple((log["log"], *(_pair(log["error_deg"].get(way), "heading", "tilt") for way in ways)) for log in logs)
    caption = (
        "Attitude on recordings against their truth. Root mean square error of heading / tilt in degrees, from the calibration on; "
        "all are fed the same samples."
    )
    return [*blocks, Grid("recorded", caption, ("log", *(WAYS[way] for way in ways)), errors)]


def _pair(figures: Figures | None, first: str, second: str) -> str:
    found = figures or {}
    return f"{number(found.get(first), 2)} / {number(found.get(second), 2)}" if found else DASH


def _camera(camera: Figures) -> list[Block]:
    rows = []
    for log in camera["logs"]:
        for name, reading in (("as recorded", "as_recorded"), ("axes, offset and lag fitted", "fitted")):
            found = log[reading]
            values = (number(found[key], 2) for key in ("turn_median_deg", "median_deg", "p90_deg"))
            rows.append((log["log"], name, str(found["keyframes"]), *values))
    turn, mounting = camera["full_turn"], camera["mounting"]
    tilt = listed([f"{angle:.1f}" for angle in mounting["rotation_cam_deg"]])
    fitted = max(log["fitted"]["median_deg"] for log in camera["logs"])
    verdict = "below half a degree in all" if fitted < _AGREE_DEG else f"{fitted:.2f} degrees in the worst"
    head = ("log", "mounting", "keyframes", "turn between them", "median difference", "90 %")
    caption = "Rotation between keyframes, camera against gyroscope. Recordings of a phone in a garden; degrees."
    return [
        Heading("Camera and gyroscope", 3),
        Grid("camera-gyro", caption, head, once(rows), left=2),
        Text(
            "The recordings do not say how the phone's camera is mounted. One rotation for both logs "
            f"({tilt} degrees about x, y and z), one gyroscope offset and one lag ({mounting['lag_ms']:.0f} ms) are fitted; the "
            f"median difference is then {verdict}."
        ),
        Text(
            f"After a pan of 360 degrees ({turn['log']}) the camera alone is {abs(turn['camera_off_deg']):.1f} degrees off, the "
            f"gyroscope alone {abs(turn['gyro_off_deg']):.1f}, both together {abs(turn['together_off_deg']):.1f}: errors of single "
            "pairs of pictures add up, and the filter takes the rotation from the gyroscope."
        ),
    ]
