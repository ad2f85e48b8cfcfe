"""An uploaded walk replayed in a process of its own, which pushes to its server as any rig does.

    python -m server.replay_process MEMORY_BYTES

reads one line of JSON, a `ReplayJob`, answers with one, `{}` or `{"error": …}`, and plays until its standard input ends: with the
server that started it, whatever becomes of that.
"""

import sys
from pathlib import Path
from threading import Event, Thread
from typing import Final, Literal

import msgspec

from server.confinement import confine, tell

LONGEST_JOB: Final = 64 * 1024


class ReplayJob(msgspec.Struct, frozen=True, kw_only=True):
    """What is to be played, and where to."""

    log: str
    site: str
    estimator: str | None
    anchor: Literal["site", "here"]
    looping: bool
    url: str
    token: str
    trust: str | None = None
    """The certificate, PEM, that the server must show."""


class Answer(msgspec.Struct, frozen=True, omit_defaults=True):
    """Whether it plays."""

    error: str | None = None


def _play(job: ReplayJob) -> None:
    # imported once the limits are set
    from assets.site import load_site
    from assets.terrain import build_terrain
    from server.replay import Replay, ReplaySettings
    from server.standing import eye_heights, origin_of
    from tracker.log import Log

    site = load_site(Path(job.site))
    replay = Replay(
        Log.open(Path(job.log)),
        ReplaySettings(job.estimator, job.anchor, looping=job.looping),
        site_origin=origin_of(site),
        ground_z_m=build_terrain(site).ground_z_m,
        eyes_z_m=eye_heights(site),
        eye_height_m=site.eye_height_m,
    )
    try:
        replay.start(job.url, job.token, job.trust)
        tell(Answer())
        stop = Event()
        Thread(target=_wait_for_the_end, args=(stop,), name="stdin", daemon=True).start()
        while not stop.wait(0.2):
            if replay.error is not None:
                raise replay.error
    finally:
        replay.close()


def _wait_for_the_end(stop: Event) -> None:
    sys.stdin.buffer.read()
    stop.set()


def _main() -> int:
    confine(int(sys.argv[1]))
    try:
        job = msgspec.json.decode(sys.stdin.buffer.readline(LONGEST_JOB), type=ReplayJob)
        _play(job)
    except MemoryError:
        tell(Answer("Replaying this walk takes more memory than it may."))
    except Exception as exc:  # the server tells whoever watches, and whoever asked
        tell(Answer(str(exc).replace(job.log, "The walk") or type(exc).__name__))
    else:
        return 0
    return 1


if __name__ == "__main__":
    sys.exit(_main())
