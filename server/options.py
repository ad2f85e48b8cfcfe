"""Options that several commands have, what is made of them, and where a checkout's files lie."""

from dataclasses import replace
from pathlib import Path
from signal import SIGINT, SIGTERM, signal
from threading import Event
from typing import Annotated, Literal

import typer

from assets.site import Site, load_site
from server.terminal import terminal
from tracker.estimators import ESTIMATORS

ROOT = Path(__file__).parents[1]
SITE = ROOT / "assets" / "state_agora"
WEB = ROOT / "web" / "dist"

_MODELS = ", ".join(dict.fromkeys(name.rpartition("/")[2] for name in ESTIMATORS if "/" in name))
EstimatorName = Annotated[
    str | None,
    typer.Option("--estimator", help=f"gps-imu/MODEL or camera-gps-imu/MODEL, MODEL one of {_MODELS}; or truth."),
]
Anchor = Annotated[
    Literal["site", "here"],
    typer.Option(help="`here` lays the site's origin at the walk's first fix: any recording then shows the square."),
]
Height = Annotated[
    Literal["ground", "gps"], typer.Option(help="Where the eyes are: on the ground's model, or where the GPS says.")
]
Eyes = Annotated[
    float | None,
    typer.Option(
        "--eye-height", min=0.5, max=2.5, help="Of the rig above the ground, metres.", show_default="the site's own"
    ),
]
Port = Annotated[int, typer.Option(min=0, max=65535, help="Port on this machine; 0 takes a free one.")]
Browser = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")]
SiteFolder = Annotated[Path, typer.Option("--site", help="The folder of the site.", show_default="the State Agora")]
LookAgain = Annotated[
    bool,
    typer.Option(
        "--look-again", help="Look at the pictures anew where the walk holds what the live front end made of them."
    ),
]


def site_with(folder: Path, eye_height_m: float | None) -> Site:
    """Return the site in a folder, with eyes of another height where one is given."""
    site = load_site(folder)
    return site if eye_height_m is None else replace(site, eye_height_m=eye_height_m)


def stop_asked() -> Event:
    """Return an event that is set when somebody asks this program to end: ctrl-C, or the system's own manager."""
    stop = Event()
    for number in (SIGINT, SIGTERM):
        signal(number, lambda *_: stop.set())
    return stop


def require_built(site: Site, web: Path = WEB) -> None:
    """End the program where there is nothing to serve yet."""
    if not (web / "index.html").is_file() or not any((site.folder / "built").glob("*.glb")):
        terminal(stderr=True).print(
            "agora: the pages or the models are not built yet: run `make setup` (or `make demo`).", soft_wrap=True
        )
        raise typer.Exit(3)
