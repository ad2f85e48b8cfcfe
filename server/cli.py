"""`agora`: the command line, and the one place where everything is put together."""

import json
import logging
import sys
import webbrowser
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal, NoReturn

import typer
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

from assets.errors import AssetError
from assets.site import Site, load_site
from server import live_commands, options
from server.calibrating.commands import calibrate
from server.doctor.command import doctor
from server.errors import ServerError
from server.options import (
    WEB,
    Anchor,
    Browser,
    EstimatorName,
    Eyes,
    Height,
    LookAgain,
    Port,
    SiteFolder,
    require_built,
    site_with,
    stop_asked,
)
from server.serve_command import serve
from server.token_command import token
from tracker.errors import InputError
from tracker.estimators import check_name
from tracker.fuzzy import INDICES, LEVELS, NEXT_INDEX, rules_by_name

SITE = options.SITE
DEMO_LOG = options.ROOT / "assets" / "demo" / "state-agora-walk.mcap"

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Outdoor augmented reality for heritage sites: walk, replay a walk, measure a tracker, simulate, build a site's models.",
)
app.command()(live_commands.walk)
app.command()(live_commands.track)
app.command()(live_commands.record)
app.command()(serve)
app.command()(token)
app.command()(doctor)
app.add_typer(calibrate, name="calibrate")
out = Console(highlight=False)
err = Console(stderr=True, highlight=False)

LogFile = Annotated[Path, typer.Argument(help="A walk: a ROS 2 bag in one MCAP file.", metavar="LOG")]


@app.command()
def demo(
    estimator: EstimatorName = None,
    anchor: Anchor = "site",
    height: Height = "ground",
    eyes: Eyes = None,
    port: Port = 8470,
    browser: Browser = True,
    site: SiteFolder = SITE,
) -> None:
    """Play the recorded walk that comes with Agora as AR in a browser, again and again; ctrl-C ends it."""
    _show(DEMO_LOG, estimator, anchor, height, port, browser, site_with(site, eyes), looping=True)


@app.command()
def replay(
    log: LogFile,
    estimator: EstimatorName = None,
    anchor: Anchor = "site",
    height: Height = "ground",
    eyes: Eyes = None,
    port: Port = 8470,
    browser: Browser = True,
    loop: Annotated[bool, typer.Option("--loop", help="Begin again at the end.")] = False,
    look_again: LookAgain = False,
    site: SiteFolder = SITE,
) -> None:
    """Play a recorded walk as AR in a browser; ctrl-C ends it."""
    _show(log, estimator, anchor, height, port, browser, site_with(site, eyes), looping=loop, look_again=look_again)


def _show(
    path: Path,
    estimator: str | None,
    anchor: Literal["site", "here"],
    height: Literal["ground", "gps"],
    port: int,
    browser: bool,
    site: Site,
    *,
    looping: bool,
    look_again: bool = False,
) -> None:
    # imported here, so that `agora rules` need not wait for a web server
    from server.replay import ReplaySettings
    from server.showing import Showing
    from tracker.log import Log

    if estimator is not None:
        check_name(estimator)
    log = Log.open(path)
    settings = ReplaySettings(estimator, anchor, height, looping, look_again)
    require_built(site)
    stop = stop_asked()
    with Showing(site, log, settings, port=port, web=WEB) as showing:
        out.print(f"Agora is at {showing.url}", soft_wrap=True)
        sys.stdout.flush()
        if browser:
            webbrowser.open(showing.page)
        while not stop.wait(0.2):
            showing.check()


@app.command()
def evaluate(
    logs: Annotated[list[Path], typer.Argument(help="Walks as MCAP files.", metavar="LOG...")],
    estimator: Annotated[
        list[str] | None, typer.Option(help="May be given more than once; all that the sensors allow where it is not.")
    ] = None,
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the figures here.", metavar="FILE")] = None,
    poses: Annotated[
        Path | None, typer.Option(help="Write LOG.ESTIMATOR.tum here, for other tools.", metavar="DIR")
    ] = None,
    change: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            help="Change a setting, for instance m_P=literal_enu; `agora settings` lists them. May be given more than once.",
            metavar="KEY=VALUE",
        ),
    ] = None,
    report: Annotated[
        Path | None, typer.Option(help="Write tables and figures here, as index.html and files.", metavar="DIR")
    ] = None,
    ground: Annotated[
        bool,
        typer.Option("--ground", help="The walks were on the site's ground as it is modelled: precise measures by it."),
    ] = False,
    look_again: LookAgain = False,
    eyes: Eyes = None,
    site: SiteFolder = SITE,
) -> None:
    """Measure estimators on recorded walks: the paper's filter error, and the error against truth where there is one."""
    import cv2

    from server.evaluation import evaluate as evaluate_logs
    from server.evaluation import print_table, write_json
    from server.plots.trace import Trace, trace_of
    from server.settings import choose

    settings, place = choose(change or ()), site_with(site, eyes)
    traces: list[Trace] = []
    cv2.setNumThreads(1)  # a rig has other work for its cores, and figures should not depend on how many there are
    with _progress("evaluating") as bar:
        task = bar.add_task("", total=1.0)
        evaluation = evaluate_logs(
            logs,
            tuple(estimator or ()),
            poses,
            lambda label, done: bar.update(task, description=label, completed=done),
            settings,
            (lambda result: traces.append(trace_of(result))) if report is not None else (lambda result: None),
            place if ground else None,
            look_again=look_again,
        )
    if json_file is not None:
        write_json(evaluation, json_file)
    if report is not None:
        from server.report import report_of, write_report  # late: matplotlib takes a second

        page = write_report(report_of(evaluation, traces, place), report)
        err.print(f"agora: the report is {page}", soft_wrap=True)
    wide = out if out.is_terminal else Console(highlight=False, width=170)
    print_table(evaluation, wide)


@app.command()
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
    with _progress("simulating") as bar:
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
    out.print(f"{log}: {settings.duration_s:.0f} s, {size / 1e6:.1f} MB")


@app.command()
def build(
    site: Annotated[Path, typer.Argument(help="The folder of the site.", show_default="the State Agora")] = SITE,
    report: Annotated[bool, typer.Option("--report", help="Print sizes and counts as JSON.")] = False,
) -> None:
    """Build a site's models (glTF) from its facts."""
    from assets.build import build as build_models

    place = load_site(site)
    with _progress("building") as bar:
        task = bar.add_task(place.name["en"], total=1.0)
        built = build_models(place, place.folder / "built", lambda done: bar.update(task, completed=done))
    if report:
        out.print_json(json.dumps(built.as_dict()))


@app.command()
def rules(as_json: Annotated[bool, typer.Option("--json", help="All 81 rules as JSON.")] = False) -> None:
    """Show the fuzzy controller's rules: which motion model follows which, by the size of the innovation."""
    if as_json:
        out.print_json(json.dumps(rules_by_name()))
        return
    from rich.table import Table

    table = Table(
        title="The coefficient that follows 0, 1, 2, for position (P) and rotation (R) alike", title_justify="left"
    )
    table.add_column("innovation")
    for index in INDICES:
        table.add_column(f"{index} becomes", justify="right")
    for level in LEVELS:
        table.add_row(level, *map(str, NEXT_INDEX[level]))
    out.print(table)
    out.print("All 81 rules by name: agora rules --json", style="dim")


@app.command()
def settings() -> None:
    """List the settings of the estimators that `agora evaluate --set KEY=VALUE` changes, each with its default."""
    from rich.padding import Padding

    from server.settings import all_settings

    for setting in all_settings():
        out.print(f"[bold]{setting.key}[/bold] = [cyan]{escape(setting.text)}[/cyan]")
        out.print(Padding(setting.meaning, (0, 0, 1, 4)), markup=False)
    out.print("The end of a name is enough: agora evaluate LOG --set m_P=literal_enu", style="dim")


@contextmanager
def _progress(what: str) -> Iterator[Progress]:
    columns = (
        TextColumn(what),
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=err, transient=True) as bar:
        yield bar


def main() -> NoReturn:
    """Run a command; what the user can mend is one sentence and exit code 2, a missing device or library 3."""
    logging.basicConfig(level=logging.WARNING, format="agora: %(message)s")
    try:
        app(standalone_mode=True)
    except (InputError, AssetError, ServerError) as error:
        err.print(f"agora: {error}", soft_wrap=True, markup=False)
        sys.exit(getattr(error, "exit_code", 2))
    sys.exit(0)
