"""A recorded walk read for its replay's page, in a process of its own: strangers may have sent it.

    python -m server.reviewing.process MEMORY_BYTES CPU_S

reads one line of JSON, a `jobs.Job`, and writes the answer; or, ending with 1, a `jobs.Refusal`.
"""

import sys
from pathlib import Path
from typing import Final

import msgspec

from server.confinement import confine
from server.reviewing.jobs import CourseJob, Job, PackJob, Refusal, ThumbnailsJob, TimelineJob

_LONGEST_JOB: Final = 64 * 1024


def _answer(job: Job) -> bytes:
    # imported once the limits are set
    from server.reviewing.course import course_of
    from server.reviewing.pack import packed
    from server.reviewing.thumbnails import thumbnails_of
    from server.reviewing.timeline import timeline_of
    from server.tuning import tune
    from tracker.log import Log

    tune()
    log = Log.open(Path(job.log))
    match job:
        case TimelineJob():
            return msgspec.json.encode(timeline_of(log))
        case ThumbnailsJob():
            return thumbnails_of(log)
        case CourseJob():
            return msgspec.json.encode(course_of(log, job.estimator))
        case PackJob():
            return packed(log, job)


def _refusal(job: Job, exc: Exception) -> Refusal:
    from server.errors import LogRefused

    words = str(exc).replace(job.log, "The walk") or type(exc).__name__
    return Refusal(exc.status if isinstance(exc, LogRefused) else 422, words)


def main() -> int:
    """Answer one job."""
    confine(int(sys.argv[1]), int(sys.argv[2]))
    job = msgspec.json.decode(sys.stdin.buffer.readline(_LONGEST_JOB), type=Job)
    try:
        answer, status = _answer(job), 0
    except MemoryError:
        answer, status = msgspec.json.encode(Refusal(413, "Reading this walk takes more memory than it may.")), 1
    except Exception as exc:  # whoever asked is told
        answer, status = msgspec.json.encode(_refusal(job, exc)), 1
    sys.stdout.buffer.write(answer)
    sys.stdout.buffer.flush()
    return status


if __name__ == "__main__":
    sys.exit(main())
