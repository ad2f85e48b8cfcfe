"""`agora simulate`: a visitor's walk with full truth, written as a log."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

import typer

from assets.site import load_site
from server.options import SITE, SiteFolder
from server.progress import progress_bar
from server.terminal import terminal


def simulate(
    log: Annotated[Path, typer.Argument(help="The log to write.", metavar="OUT")],
    seed: Annotated[int, typer.Option(min=0, help="Another seed, another walk.")] = 1,
    duration: Annotated[float | None, typer.Option(min=1.0, help="Seconds; 75, or the walk's own.")] = None,
    camera: Annotated[
        bool, typer.Option("--camera", help="Render what the camera sees (about 4 pictures a second).")
    ] = False,
    dataset: Annotated[int, typer.Option(min=0, max=5, help="In the manner of the paper's dataset 1 to 5.")] = 0,
    plan: Annotated[
        Literal["chance", "demo"],
        typer.Option(
            "--walk",
            help="`demo` is the demo's: past temple, Prytaneion, Basilica and Odeon, with stops and landmarks tapped.",
        ),
    ] = "chance",
    video: Annotated[Literal["h264", "jpeg"], typer.Option(help="How pictures are stored.")] = "h264",
    site: SiteFolder = SITE,
) -> None:
    """Simulate a visitor's walk across the site: IMU, magnetometer, GPS, camera and full truth, the same for the same seed."""
    from assets.terrain import build_terrain
    from assets.today import build_today
    from server.pointing import DEMO_POINTINGS, pointed_out
    from server.simulation import write_walk
    from server.site_tour import tour_of
    from server.standing import origin_of
    from tracker.choreography import DATASET_DURATION_S
    from tracker.simulate import DEMO_WALK, WalkSettings

    place = load_site(site)
    if plan == "demo" and dataset:
        raise typer.BadParameter("a walk is the demo's or in the manner of a dataset, not both", param_hint="--walk")
    base = (
        DEMO_WALK if plan == "demo" else WalkSettings(dataset=dataset, duration_s=DATASET_DURATION_S.get(dataset, 75.0))
    )
    settings = replace(
        base,
        seed=seed,
        duration_s=duration or base.duration_s,
        tour=tour_of(place),
        origin=origin_of(place),
        eye_height_m=place.eye_height_m,
    )
    with progress_bar("simulating") as bar:
        task = bar.add_task("rendering" if camera else "writing", total=1.0)
        scene = build_today(place, lambda _: None) if camera else None
        size = write_walk(
            log,
            settings,
            ground_z_m=build_terrain(place).ground_z_m,
            scene=scene,
            video=video,
            progress=lambda done: bar.update(task, completed=done),
            pointed=lambda walk: pointed_out(walk, DEMO_POINTINGS if plan == "demo" else (), place.landmarks),
        )
    terminal().print(f"{log}: {settings.duration_s:.0f} s, {size / 1e6:.1f} MB")
