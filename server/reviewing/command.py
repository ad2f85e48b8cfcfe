"""`agora export`: a recorded walk as one HTML file."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from server.options import SITE, WEB, Anchor, EstimatorName, SiteFolder
from server.reviewing.page_size import DEFAULT_MB, LARGEST_MB, SMALLEST_MB
from server.terminal import terminal


def export(
    log: Annotated[Path, typer.Argument(help="A walk: a ROS 2 bag in one MCAP file.", metavar="LOG")],
    page: Annotated[Path, typer.Argument(help="The file to write.", metavar="OUT.html")],
    estimator: EstimatorName = None,
    anchor: Anchor = "site",
    pictures: Annotated[
        bool,
        typer.Option("--pictures/--no-pictures", help="Whether the camera's pictures are in it; bystanders are, too."),
    ] = True,
    max_mb: Annotated[
        int,
        typer.Option("--max-mb", min=SMALLEST_MB, max=LARGEST_MB, help="Fewer pictures a second where it is larger."),
    ] = DEFAULT_MB,
    site: SiteFolder = SITE,
) -> None:
    """Save a recorded walk as one HTML file that plays in a browser without server and network."""
    import msgspec

    from assets.site import load_site
    from server.errors import LogRefused
    from server.reviewing.course import course_of
    from server.reviewing.exported import Exporter
    from server.reviewing.jobs import PackJob
    from server.reviewing.pack import packed, unpacked
    from server.reviewing.thumbnails import thumbnails_of
    from server.reviewing.timeline import timeline_of
    from server.site_facts import site_facts
    from server.tuning import tune
    from tracker.errors import InputError, MissingSensor
    from tracker.log import Log

    tune()
    place, walk = load_site(site), Log.open(log)
    models = place.folder / "built"
    exporter = Exporter(WEB, models, place.folder, site_facts(place, models))
    with terminal(stderr=True).status(f"packing {walk.name}"):
        room = exporter.left_for_frames(max_mb)
        pack = packed(walk, PackJob(str(log), str(place.folder), estimator, anchor, pictures, room))
        course = thumbnails = None
        with suppress(MissingSensor):
            course = msgspec.json.encode(course_of(walk, unpacked(pack)[0].estimator))
        with suppress(LogRefused):
            thumbnails = thumbnails_of(walk) if pictures else None
        text = exporter.page(walk.name, pack, msgspec.json.encode(timeline_of(walk)), course, thumbnails)
    try:
        page.write_text(text, encoding="utf-8")
    except OSError as exc:
        raise InputError(f"{page} cannot be written: {exc.strerror}.") from exc
    terminal().print(f"{page}: {walk.info.duration_s:.0f} s, {len(text) / 1e6:.1f} MB", soft_wrap=True)
