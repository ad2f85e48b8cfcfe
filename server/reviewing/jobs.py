"""What can be asked of a recorded walk, as values: what the process that reads it is told, and how its answer is kept."""

from typing import Final, Literal, TypeAlias

from msgspec import Struct


class TimelineJob(Struct, frozen=True, tag="timeline"):
    """Length, pictures and events: `timeline.Timeline` as JSON."""

    log: str


class ThumbnailsJob(Struct, frozen=True, tag="thumbnails"):
    """The strip of small pictures: JPEG."""

    log: str


class CourseJob(Struct, frozen=True, tag="course"):
    """What an estimator makes of it: `course.Course` as JSON."""

    log: str
    estimator: str


class PackJob(Struct, frozen=True, tag="pack"):
    """Every picture as a frame message, to be played without a server: see `pack.py`."""

    log: str
    site: str
    estimator: str | None
    anchor: Literal["site", "here"]
    pictures: bool
    """Whether the camera's pictures are in it; else empty ones, over which the square is drawn."""
    max_bytes: int


Job: TypeAlias = TimelineJob | ThumbnailsJob | CourseJob | PackJob

MEDIA_TYPES: Final[dict[type, str]] = {
    TimelineJob: "application/json",
    ThumbnailsJob: "image/jpeg",
    CourseJob: "application/json",
    PackJob: "application/octet-stream",
}


class Refusal(Struct, frozen=True):
    """Why there is no answer."""

    status: int
    """Of HTTP."""
    error: str
