"""`agora walk`, `agora track` and `agora record`: the commands with live sensors."""

import json
import sys
import webbrowser
from contextlib import nullcontext
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.live import Live

from assets.site import Site
from server.options import (
    SITE,
    WEB,
    Anchor,
    Browser,
    EstimatorName,
    Eyes,
    Height,
    Port,
    SiteFolder,
    require_built,
    site_with,
    stop_asked,
)
from server.terminal import terminal

Gps = Annotated[
    str,
    typer.Option(
        "--gps", help="phidget[:SERIAL], serial:DEVICE[:BAUD], gpsd[:HOST:PORT], log:FILE or none.", metavar="SOURCE"
    ),
]
Imu = Annotated[str, typer.Option("--imu", help="phidget[:SERIAL], log:FILE or none.", metavar="SOURCE")]
Camera = Annotated[
    str,
    typer.Option("--camera", help="A number, /dev/video0, rtsp://…, a video file, log:FILE or none.", metavar="SOURCE"),
]
RigPlace = Annotated[
    Path | None,
    typer.Option(
        "--rig", help="What `agora calibrate` wrote.", metavar="FILE", show_default="~/.config/agora/rig.toml"
    ),
]
RecordFolder = Annotated[
    Path | None, typer.Option("--record", help="Record the walk into a new file here.", metavar="DIR")
]
AsJson = Annotated[bool, typer.Option("--json", help="A line of JSON each second instead of the screen.")]

if TYPE_CHECKING:
    from server.walking import Walking

out = terminal()


def walk(
    gps: Gps = "phidget",
    imu: Imu = "phidget",
    camera: Camera = "0",
    rig: RigPlace = None,
    estimator: EstimatorName = None,
    record: RecordFolder = None,
    anchor: Anchor = "site",
    height: Height = "ground",
    eyes: Eyes = None,
    port: Port = 8470,
    browser: Browser = True,
    site: SiteFolder = SITE,
    as_json: AsJson = False,
) -> None:
    """Walk with live sensors and see the square in a browser on this machine; ctrl-C ends it."""
    _run((gps, imu, camera), rig, estimator, anchor, height, site_with(site, eyes), as_json, folder=record, port=port,
         web=WEB, browser=browser)  # fmt: skip


def track(
    to: Annotated[str, typer.Option("--to", help="The server: wss://HOST.", metavar="URL")],
    token: Annotated[str, typer.Option("--token", envvar="AGORA_TOKEN", help="That lets this rig in.")],
    session: Annotated[str, typer.Option("--session", help="The walk's name on the server.")] = "walk",
    gps: Gps = "phidget",
    imu: Imu = "phidget",
    camera: Camera = "0",
    rig: RigPlace = None,
    estimator: EstimatorName = None,
    record: RecordFolder = None,
    anchor: Anchor = "site",
    height: Height = "ground",
    eyes: Eyes = None,
    site: SiteFolder = SITE,
    as_json: AsJson = False,
) -> None:
    """Track with live sensors and push to a server elsewhere, whether it is there or not; ctrl-C ends it."""
    _run((gps, imu, camera), rig, estimator, anchor, height, site_with(site, eyes), as_json, folder=record,
         to=to, token=token, session=session)  # fmt: skip


def record(
    log: Annotated[Path, typer.Argument(help="The recording to write: a ROS 2 bag in MCAP.", metavar="OUT")],
    gps: Gps = "phidget",
    imu: Imu = "phidget",
    camera: Camera = "0",
    rig: RigPlace = None,
    site: SiteFolder = SITE,
    as_json: AsJson = False,
) -> None:
    """Record live sensors for later, without tracking; ctrl-C ends it."""
    _run((gps, imu, camera), rig, None, "site", "ground", site_with(site, None), as_json, log=log)


def _run(
    specs: tuple[str, str, str],
    rig: Path | None,
    estimator: str | None,
    anchor: Literal["site", "here"],
    height: Literal["ground", "gps"],
    site: Site,
    as_json: bool,
    *,
    folder: Path | None = None,
    log: Path | None = None,
    web: Path | None = None,
    port: int = 0,
    browser: bool = False,
    to: str | None = None,
    token: str = "",
    session: str = "walk",
) -> None:
    # imported here, so that `agora rules` need not wait for a web server
    from server.rig_sources import RigSources
    from server.tuning import settle, tune
    from server.walking import Walking, WalkSettings, known_rig, recording_in, rig_text
    from tracker.rig_file import find_rig_file

    if web is not None:
        require_built(site)
    tune()
    rig_file = find_rig_file(rig)
    makers = RigSources(rig_file)
    sources = makers.make(gps=specs[0], imu=specs[1], camera=specs[2])
    settings = WalkSettings(
        estimator,
        anchor,
        height,
        record=recording_in(folder) if folder is not None else log,
        tracks=log is None,
        about={"rig": rig_text(rig), "gps": specs[0], "imu": specs[1], "camera": specs[2]},
        rig_file=known_rig(rig),
    )
    stop = stop_asked()
    with Walking(
        site, sources, makers.rig(), settings,
        correct=rig_file.correct, web=web, port=port, server_url=to, token=token, session=session,
    ) as walking:  # fmt: skip
        settle()
        if walking.url is not None:
            out.print(f"Agora is at {walking.url}", soft_wrap=True)
            sys.stdout.flush()
        if browser and walking.page is not None:
            webbrowser.open(walking.page)
        _follow(walking, stop, as_json)


def _follow(walking: "Walking", stop: Event, as_json: bool) -> None:
    from server.status_screen import screen

    if as_json:
        while not stop.wait(1.0):
            walking.check()
            out.out(json.dumps(walking.as_json()))
            sys.stdout.flush()
        return
    with Live(console=out, auto_refresh=False, screen=False) if out.is_terminal else nullcontext() as live:
        while not stop.wait(0.5):
            walking.check()
            if live is not None:
                shown = screen(
                    walking.state,
                    estimator=walking.rig.estimator,
                    connected=walking.connected,
                    url=walking.url,
                    refused=walking.refused,
                )
                live.update(shown, refresh=True)
