"""What the console says of a walk, as Markdown. Pure."""

import re
from typing import Any

import numpy as np

from server.console.walk import Walk
from server.wire import FrameMeta

NOBODY = "*Nobody walks. A rig that connects, or a replay that begins, appears here by itself.*"


def status_of(walk: Walk) -> str:
    """Return what is known of a walk just now."""
    session = walk.session
    if not session:
        return "*Connecting ...*"
    kind = "Replay" if walk.is_replay else "Live walk"
    lines = [f"**{plain(walk.title)}** · {kind}, {plain(session['estimator'] or 'no estimator')}"]
    if walk.watching > 1:
        lines.append("One viewer" if walk.watching == 2 else f"{walk.watching - 1} viewers")
    if session["notice"]:
        lines.append(f"⚠ {plain(session['notice'])}")
    lines += _pose(walk.frame)
    lines += [_sensor(name, health) for name, health in session["health"].items()]
    return "\n\n".join(lines)


def rejected_of(walk: Walk) -> str:
    """Return which measurements the estimator did not use."""
    counts = walk.history.rejected
    if not counts:
        return "Every measurement was used so far."
    rows = [f"| {plain(reason.replace('_', ' '))} | {count} |" for reason, count in sorted(counts.items())]
    return "\n".join(["| Not used, because | times |", "| --- | ---: |", *rows])


def plain(text: str) -> str:
    """Return a text with what Markdown and HTML would take for markup taken for itself."""
    return re.sub(r"([\\`*_{}\[\]()#+!|<>~&])", r"\\\1", text)


def _pose(frame: FrameMeta | None) -> list[str]:
    if frame is None or not frame.pose_valid:
        return ["It has no pose yet."]
    east, north, up = frame.T_site_cam[:3, 3].tolist()
    sigma_m = float(np.sqrt(max(0.0, np.trace(frame.cov[:2, :2]))))
    sigma_deg = float(np.degrees(np.sqrt(max(0.0, frame.cov[5, 5]))))
    ahead = frame.T_site_cam[:3, 2]
    heading_deg = float(np.degrees(np.arctan2(ahead[0], ahead[1]))) % 360.0
    known = "" if frame.heading_known else ", not known yet"
    speed_m_s = float(np.hypot(*frame.v_site_m_s[:2]))
    return [
        f"| at {frame.position_s:.1f} s | |\n| --- | --- |\n"
        f"| east, north, up | {east:.2f}, {north:.2f}, {up:.2f} m |\n"
        f"| sure to (1σ) | {sigma_m:.2f} m, {sigma_deg:.1f}° |\n"
        f"| looks to | {heading_deg:.0f}° from north{known} |\n"
        f"| speed, motion model | {speed_m_s:.1f} m/s, {plain(frame.motion_model)} |"
    ]


def _sensor(name: str, health: dict[str, Any]) -> str:
    mark = "⚠" if health["trouble"] else "✓"
    return f"{mark} **{plain(name)}** {health['rate_hz']:.0f} Hz: {plain(health['sentence'])}"
