"""`make soak`: ten minutes of a live walk, an hour of viewers, and eight hours of a rig, with limits and verdicts in docs/soak.md.

A run that was interrupted goes on with the part that was; what that part had measured is told apart.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from shutil import rmtree

import cv2
from rich.console import Console

from tests.benchmarks.soak import hours, live, viewers
from tests.benchmarks.soak.journal import Journal, Session, interrupted
from tests.benchmarks.soak.process import lateness_ms, load
from tests.benchmarks.soak.rows import Row, append, section
from tests.benchmarks.soak.to_and_fro import demo_pictures, write_log
from tracker.log import Log

ROOT = Path(__file__).parents[3]
PARTS = ("live", "viewers", "hours")
_DEMO = ROOT / "assets" / "demo" / "state-agora-walk.mcap"
_HALF_HOUR_S = 1800.0
_REAL_TIME = ("chrt", "-r", "10")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run what is left to run; return 0 where every limit holds."""
    asked = _parser().parse_args(arguments)
    cv2.setNumThreads(1)
    console, folder, document = Console(), asked.folder, asked.document
    commit = _git("rev-parse", "--short", "HEAD") + (" with changes" if _git("status", "--porcelain") else "")
    for run in interrupted(folder):
        append(document, section(f"{run.about['when']}: {run.about['title']}, interrupted",
                                 [f"Of commit {run.about['commit']}; it had told its figures {run.lines} times."], []))  # fmt: skip
    session = Session(folder, PARTS if asked.only is None else (asked.only,), commit)
    all_met = True
    for part in session.left:
        title = {
            "live": f"{asked.minutes:g} minutes, live",
            "viewers": f"{asked.watched:g} minutes of replay, with {viewers.PLACES} viewers that come and go",
            "hours": f"{asked.hours:g} hours, as fast as possible",
        }[part]
        about = {"when": f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC", "title": title, "commit": commit}
        journal, sentences = Journal(folder, part, about), [_about(commit, asked, part)]
        rows = {"live": _live, "viewers": _viewers, "hours": _hours}[part](asked, journal, console)
        sentences.append(f"Load averages after: {load()}.")
        append(document, section(f"{about['when']}: {title}", sentences, rows))
        journal.end()
        session.finish(part)
        for row in rows:
            console.print("  ".join(row.cells), markup=False)
        all_met = all_met and all(row.is_met is not False for row in rows)
    return 0 if all_met else 1


def _live(asked: argparse.Namespace, journal: Journal, console: Console) -> list[Row]:
    seconds, folder = asked.minutes * 60.0, asked.folder / "recorded"
    log = asked.folder / f"to-and-fro-{seconds:.0f}.mcap"
    if not log.exists():
        write_log(log, seconds, demo_pictures())
    rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    timer_ms = lateness_ms()
    samples = []
    for sample in live.walk(log, folder / "walk.mcap", seconds, _REAL_TIME if asked.undisturbed else ()):
        journal.add(asdict(sample))
        samples.append(sample)
        if len(samples) % 30 == 0:
            console.print(
                f"{sample.t_s:.0f} s: p99 {sample.p99_ms} ms, {sample.poses_hz} poses/s, {sample.rss_mb:.0f} MB"
            )
    info = Log.open(log).info
    kept = Log.open(folder / "walk.mcap").info.counts
    rmtree(folder)
    rows = live.rows(samples, (info.t_end_ns - info.t_start_ns) * 1e-9, kept)
    return [*rows, Row("a bare timer's lateness before it, at ordinary priority, p99", timer_ms, "ms")]


def _viewers(asked: argparse.Namespace, journal: Journal, console: Console) -> list[Row]:
    folder = asked.folder / "served"
    rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    samples = []
    for sample in viewers.walk(_DEMO, folder, asked.watched * 60.0):
        journal.add(asdict(sample))
        samples.append(sample)
        if len(samples) % 30 == 0:
            console.print(
                f"{sample.t_s:.0f} s: {sample.server_mb:.0f} and {sample.replay_mb:.0f} MB, {sample.tasks:.0f} tasks"
            )
    rmtree(folder)
    return viewers.rows(samples)


def _hours(asked: argparse.Namespace, journal: Journal, console: Console) -> list[Row]:
    marks = []
    for mark in hours.replay(asked.hours * 3600.0, min(_HALF_HOUR_S, asked.hours * 900.0)):
        journal.add(asdict(mark))
        marks.append(mark)
        console.print(f"{mark.replayed_s / 3600.0:.1f} h after {mark.took_s:.0f} s: {mark.rss_mb:.1f} MB")
    return hours.rows(marks)


def _about(commit: str, asked: argparse.Namespace, part: str) -> str:
    model = next(
        (line.partition(":")[2].strip() for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
         if line.startswith("model name")), "unknown processor",
    )  # fmt: skip
    words = f"Commit {commit}, Python {sys.version.split()[0]}, {os.cpu_count()} cores ({model})."
    if part == "live" and asked.undisturbed:
        words += " At real-time priority (`chrt -r 10`), so that others' work does not count as ours."
    return f"{words}{f' {asked.note}' if asked.note else ''} Load averages before: {load()}."


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.strip() or ("unknown" if words[0] == "rev-parse" else "")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python -m tests.benchmarks.soak", description=__doc__)
    parser.add_argument("--only", choices=PARTS, help="one part")
    parser.add_argument("--minutes", type=float, default=10.0, help="of the live walk")
    parser.add_argument("--watched", type=float, default=60.0, help="minutes of the replay with viewers")
    parser.add_argument("--hours", type=float, default=8.0, help="of the rig without camera")
    parser.add_argument(
        "--undisturbed", action="store_true", help="at real-time priority, on a machine that others use; as root"
    )
    parser.add_argument("--note", default="", help="a sentence for the page: what else ran")
    parser.add_argument(
        "--folder", type=Path, default=ROOT / "build" / "soak", help="for logs and figures while it runs"
    )
    parser.add_argument("--document", type=Path, default=ROOT / "docs" / "soak.md", help="the page that is appended to")
    return parser


if __name__ == "__main__":
    sys.exit(main())
