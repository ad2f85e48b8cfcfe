"""`agora`: the command line, and the one place where everything is put together."""

import json
import logging
import sys
import webbrowser
from pathlib import Path
from typing import Annotated, Literal, NoReturn

import typer
from rich.markup import escape

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
from server.progress import progress_bar
from server.reviewing.command import export
from server.serve_command import serve
from server.simulate_command import simulate
from server.terminal import terminal
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
app.command()(simulate)
app.command()(export)
app.add_typer(calibrate, name="calibrate")
out = terminal()
err = terminal(stderr=True)

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
    with progress_bar("evaluating") as bar:
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
    wide = out if out.is_terminal else terminal(width=170)
    print_table(evaluation, wide)


@app.command()
def build(
    site: Annotated[Path, typer.Argument(help="The folder of the site.", show_default="the State Agora")] = SITE,
    report: Annotated[bool, typer.Option("--report", help="Print sizes and counts as JSON.")] = False,
) -> None:
    """Build a site's models (glTF) from its facts."""
    from assets.build import build as build_models

    place = load_site(site)
    with progress_bar("building") as bar:
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


def main() -> NoReturn:
    """Run a command; what the user can mend is one sentence and exit code 2, a missing device or library 3."""
    logging.basicConfig(level=logging.WARNING, format="agora: %(message)s")
    try:
        app(standalone_mode=True)
    except (InputError, AssetError, ServerError) as error:
        err.print(f"agora: {error}", soft_wrap=True, markup=False)
        sys.exit(getattr(error, "exit_code", 2))
    sys.exit(0)
