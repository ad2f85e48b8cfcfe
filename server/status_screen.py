"""How a live walk is, on one screen for people and as JSON for programs. Pure: values in, text out."""

from collections.abc import Mapping
from math import degrees, hypot, pi, sqrt
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from tracker.estimator import Pose
from tracker.geometry import yaw_of
from tracker.running.health import SensorState
from tracker.running.walk import WalkState

_STYLES: Mapping[SensorState, str] = {SensorState.WAITING: "yellow", SensorState.STREAMING: "green"}


def as_json(state: WalkState, *, estimator: str, connected: bool | None, refused: str | None = None) -> dict[str, Any]:
    """Return everything; `connected` is None where there is no server to connect to, `refused` why it will not have this rig."""
    return {
        "estimator": estimator,
        "connected": connected,
        "refused": refused,
        "pose": None if state.pose is None else _pose(state.pose),
        "poses_hz": round(state.poses_hz, 1),
        "vision_hz": round(state.looks_hz, 1),
        "latency_ms": {
            "p50": state.latency_p50_ms,
            "p99": state.latency_p99_ms,
            "longest": round(state.latency_longest_ms, 3),
        },
        "sensors": {name: health.as_json() for name, health in state.sensors.items()},
        "lost": dict(state.lost),
        "withheld": dict(state.withheld),
        "rejected": dict(state.rejected),
        "recorder": None if state.recorder is None else state.recorder.as_json(),
    }


def screen(
    state: WalkState, *, estimator: str, connected: bool | None, url: str | None, refused: str | None = None
) -> RenderableType:
    """Return the screen."""
    sensors = Table(box=None, padding=(0, 2, 0, 0), show_header=False)
    for name, health in state.sensors.items():
        style = _STYLES.get(health.state, "bold red")
        sensors.add_row(Text(name), Text(health.state.value, style=style), Text(health.sentence))
    if refused is not None:
        sensors.add_row(Text("server"), Text("refused", style="bold red"), Text(f"{refused} Tracking goes on."))
    elif connected is not None:
        words = ("connected", "green") if connected else ("away", "bold red")
        told = "The server is there." if connected else "The server is away: tracking goes on, and it is asked again."
        sensors.add_row(Text("server"), Text(*words), Text(told))
    if (recorder := state.recorder) is not None:
        words = ("recording", "green") if recorder.is_recording else ("stopped", "bold red")
        told = recorder.warning or f"{recorder.path.name}: {recorder.bytes / 1e6:.1f} MB."
        sensors.add_row(Text("log"), Text(*words), Text(told))
    lines: list[RenderableType] = [] if url is None else [Text(f"Agora is at {url}", style="bold")]
    lines += [sensors, Text(_figures(state, estimator), style="dim")]
    if any(state.lost.values()):
        lines.append(Text(f"Lost, since fusion was behind: {dict(state.lost)}", style="bold red"))
    return Group(*lines)


def _figures(state: WalkState, estimator: str) -> str:
    if not estimator:
        return "Nothing is tracked, all is recorded. Ctrl-C ends it."
    where = "no pose yet" if state.pose is None else _words(state.pose)
    vision = f", {state.looks_hz:.0f} pictures looked at" if estimator.startswith("camera") else ""
    late = "" if state.latency_p99_ms is None else f", {state.latency_p99_ms:.1f} ms behind the samples at most times"
    return f"{estimator}: {where}; {state.poses_hz:.0f} poses a second{late}{vision}. Ctrl-C ends it."


def _words(pose: Pose) -> str:
    east, north, up = pose.p_site_m
    sigma_m = sqrt(max(0.0, float(pose.cov[0, 0]), float(pose.cov[1, 1])))
    heading = f"{_heading_deg(pose):.0f}°" if pose.heading_known else "unknown"
    return f"east {east:.1f} m, north {north:.1f} m, up {up:.1f} m, ± {sigma_m:.1f} m, heading {heading}"


def _heading_deg(pose: Pose) -> float:
    return degrees((pi / 2 - yaw_of(pose.wxyz_site_body)) % (2 * pi))


def _pose(pose: Pose) -> dict[str, Any]:
    return {
        "t_ns": pose.t_ns,
        "p_site_m": list(pose.p_site_m),
        "wxyz_site_body": list(pose.wxyz_site_body),
        "speed_m_s": hypot(*pose.v_site_m_s),
        "sigma_h_m": sqrt(max(0.0, float(pose.cov[0, 0]), float(pose.cov[1, 1]))),
        "heading_deg": _heading_deg(pose) if pose.heading_known else None,
        "motion_model": pose.motion_model,
    }
