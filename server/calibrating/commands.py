"""`agora calibrate camera|rig|imu|mag|board`: the commands."""

import json
import webbrowser
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from signal import SIGINT, signal
from threading import Event
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from server.options import Browser, Port
from server.progress import progress_bar
from server.terminal import terminal
from tracker.calibrate.board import DICTIONARIES, Board
from tracker.errors import InputError
from tracker.rig_file import DEFAULT_PLACE, RigFile, read_rig_file

if TYPE_CHECKING:  # figures need matplotlib, feeds all readers of logs: every command of agora would wait for them
    from server.calibrating.feed import Feed, Progress
    from server.calibrating.result import Result

calibrate = typer.Typer(
    no_args_is_help=True,
    help="Find out how a rig's sensors err: the lens, how the camera sits and ticks, biases, and the rig's own iron.",
)
out = terminal()
err = terminal(stderr=True)

RecordedLog = Annotated[
    Path | None, typer.Option("--log", help="A recording, instead of live sensors.", metavar="FILE")
]
RigPlace = Annotated[
    Path | None,
    typer.Option("--rig", help="The rig file to write into.", metavar="FILE", show_default="~/.config/agora/rig.toml"),
]
Report = Annotated[Path | None, typer.Option("--report", help="Write figures here, as index.html.", metavar="DIR")]
AsJson = Annotated[bool, typer.Option("--json", help="What was found, as JSON.")]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Find out, and leave the rig file as it is.")]
Camera = Annotated[str, typer.Option("--camera", help="A number, /dev/video0 or rtsp://….", metavar="SOURCE")]
Imu = Annotated[str, typer.Option("--imu", help="phidget[:SERIAL].", metavar="SOURCE")]
Squares = Annotated[str, typer.Option("--squares", help="The board's squares, across and down.", metavar="CxR")]
Square = Annotated[float, typer.Option("--square", help="Width of a square, millimetres, as measured on the print.")]
Dictionary = Annotated[str, typer.Option("--dictionary", help=f"Of the markers: {', '.join(DICTIONARIES)}.")]


@calibrate.command()
def board(
    pdf: Annotated[Path, typer.Argument(help="The PDF to write.", metavar="OUT")] = Path("agora-board.pdf"),
    paper: Annotated[Literal["a4", "letter", "a3"], typer.Option(help="What is in the printer.")] = "a4",
    squares: Squares = "9x6",
    square: Square = 28.0,
    dictionary: Dictionary = "4x4_50",
) -> None:
    """Print the board: a PDF in true size, with a bar to measure whether the printer kept it."""
    from server.calibrating.board_pdf import board_pdf

    data = board_pdf(_board(squares, square, dictionary), paper)
    try:
        pdf.write_bytes(data)
    except OSError as error:
        raise InputError(f"{pdf} cannot be written to: {error.strerror}.") from error
    out.print(f"{pdf}: print it at 100 %, measure the bar, and glue it to something flat.", soft_wrap=True)


@calibrate.command()
def camera(
    log: Annotated[
        Path | None,
        typer.Option(
            "--log", help="A recording, a video or a folder of photographs, instead of a live camera.", metavar="FILE"
        ),
    ] = None,
    camera: Camera = "0",
    rig: RigPlace = None,
    squares: Squares = "9x6",
    square: Square = 28.0,
    dictionary: Dictionary = "4x4_50",
    seconds: Annotated[float, typer.Option(min=5.0, help="Give up collecting after this.")] = 180.0,
    port: Port = 0,
    browser: Browser = True,
    report: Report = None,
    as_json: AsJson = False,
    dry_run: DryRun = False,
) -> None:
    """The camera's lens, from the board shown to it; a page shows what is covered and what to do next."""
    from server.calibrating.lens_run import Collection, calibrate_camera

    place, rig_file = _rig_file(rig)
    collection = Collection(_board(squares, square, dictionary))
    feed = _feed(log, rig_file, camera=camera, seconds=seconds, has_pictures=True)
    stop = Event()
    with _page(collection, port, browser) if feed.is_live else nullcontext(), _interruptible(stop), _told() as told:
        result = calibrate_camera(feed, collection, told, stop.is_set)
        collection.finished = True
    _finish(result, place, report, as_json=as_json, dry_run=dry_run)


@calibrate.command("rig")
def rig_command(
    log: Annotated[
        list[Path] | None,
        typer.Option(
            "--log",
            help="A recording, instead of live sensors. Given several times, recordings of one rig are calibrated together.",
            metavar="FILE",
        ),
    ] = None,
    camera: Camera = "0",
    imu: Imu = "phidget",
    rig: RigPlace = None,
    squares: Squares = "9x6",
    square: Square = 28.0,
    dictionary: Dictionary = "4x4_50",
    seconds: Annotated[float, typer.Option(min=5.0, help="How long to listen.")] = 12.0,
    report: Report = None,
    as_json: AsJson = False,
    dry_run: DryRun = False,
) -> None:
    """How the camera sits beside the inertial unit and how late it is: pan, nod and tilt for ten seconds, far from things."""
    from server.calibrating.mount_run import calibrate_rig

    place, rig_file = _rig_file(rig)
    logs: Sequence[Path | None] = log or [None]
    feeds = [_feed(path, rig_file, camera=camera, imu=imu, seconds=seconds, has_pictures=True) for path in logs]
    if feeds[0].is_live and not as_json:
        out.print("Stand in the open. Pan to both sides, then nod and tilt, not too fast …")
    with _told() as told:
        result = calibrate_rig(feeds, rig_file, _board(squares, square, dictionary), told)
    _finish(result, place, report, as_json=as_json, dry_run=dry_run)


@calibrate.command()
def imu(
    log: RecordedLog = None,
    imu: Imu = "phidget",
    rig: RigPlace = None,
    seconds: Annotated[float, typer.Option(min=10.0, help="How long to listen.")] = 30.0,
    find_rest: Annotated[bool, typer.Option("--find-rest", help="Take a recording's longest rest.")] = False,
    sides: Annotated[
        bool, typer.Option("--sides", help="Rests on six sides, each five seconds: tells the accelerometer's bias too.")
    ] = False,
    report: Report = None,
    as_json: AsJson = False,
    dry_run: DryRun = False,
) -> None:
    """The inertial unit's bias and noise, from a rest; refused where the rig moves."""
    from server.calibrating.imu_run import calibrate_imu

    if sides and find_rest:
        raise typer.BadParameter("a rest on one side or rests on six, not both", param_hint="--sides")
    place, rig_file = _rig_file(rig)
    feed = _feed(log, rig_file, imu=imu, seconds=max(seconds, 60.0) if sides else seconds)
    if feed.is_live and not as_json:
        out.print(
            "Lay it on each side for five seconds …" if sides else "Lay the rig on something firm and let go of it …"
        )
    with _told() as told:
        result = calibrate_imu(feed, "sides" if sides else "longest" if find_rest else "all", told)
    _finish(result, place, report, as_json=as_json, dry_run=dry_run)


@calibrate.command()
def mag(
    log: RecordedLog = None,
    imu: Imu = "phidget",
    gps: Annotated[
        str,
        typer.Option("--gps", help="A receiver, for where this is: as for `agora walk`, or none.", metavar="SOURCE"),
    ] = "none",
    place: Annotated[
        str | None, typer.Option("--place", help="Where this is, degrees, instead of a receiver.", metavar="LAT,LON")
    ] = None,
    rig: RigPlace = None,
    seconds: Annotated[float, typer.Option(min=10.0, help="How long to listen.")] = 60.0,
    report: Report = None,
    as_json: AsJson = False,
    dry_run: DryRun = False,
) -> None:
    """The rig's own iron, from turning it slowly through all directions; judged by the World Magnetic Model."""
    from server.calibrating.mag_run import calibrate_mag

    where = None if place is None else _place(place)
    rig_place, rig_file = _rig_file(rig)
    feed = _feed(log, rig_file, imu=imu, gps=gps, seconds=seconds)
    if feed.is_live and not as_json:
        out.print("Turn the whole rig slowly about each of its axes, all the way round, as if to draw a ball …")
    with _told() as told:
        result = calibrate_mag(feed, where, told)
    _finish(result, rig_place, report, as_json=as_json, dry_run=dry_run)


# -- what the commands share ------------------------------------------------------------------------------------------


def _board(squares: str, square_mm: float, dictionary: str) -> Board:
    columns, _, rows = squares.lower().partition("x")
    if not (columns.isdecimal() and rows.isdecimal()):
        raise InputError(f"--squares {squares!r} is no board: give it as 9x6.")
    return Board(int(columns), int(rows), square_mm * 1e-3, dictionary)


def _place(text: str) -> tuple[float, float]:
    try:
        lat_deg, lon_deg = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--place {text!r} is no place: give it as 37.94,27.34.") from None
    if not (-90.0 <= lat_deg <= 90.0 and -180.0 <= lon_deg <= 180.0):
        raise InputError(f"--place {text!r} is not on the Earth: latitude first, then longitude, in degrees.")
    return lat_deg, lon_deg


def _rig_file(path: Path | None) -> tuple[Path, RigFile]:
    """Return where to write, and what is there already; a file that is not there yet is begun."""
    place = DEFAULT_PLACE.expanduser() if path is None else path
    return place, read_rig_file(place) if place.exists() else RigFile()


def _feed(
    log: Path | None,
    rig_file: RigFile,
    *,
    seconds: float,
    camera: str = "none",
    imu: str = "none",
    gps: str = "none",
    has_pictures: bool = False,
) -> "Feed":
    from server.calibrating.feed import LiveFeed, recorded_feed

    if log is not None:
        return recorded_feed(log, camera=has_pictures)
    from server.rig_sources import RigSources

    # no correction: what was found before must not hide what there is to find
    makers = RigSources(rig_file)
    return LiveFeed(makers.make(gps=gps, imu=imu, camera=camera), makers.rig(), seconds)


@contextmanager
def _told() -> Iterator["Progress"]:
    """Show a progress bar while inside."""
    with progress_bar("calibrating") as bar:
        task = bar.add_task("", total=1.0)
        yield lambda what, share: bar.update(task, description=what, completed=share)


@contextmanager
def _interruptible(stop: Event) -> Iterator[None]:
    """Let the first ctrl-C end the collecting; what was collected is then used."""
    before = signal(SIGINT, lambda *_: stop.set())
    try:
        yield
    finally:
        signal(SIGINT, before)


@contextmanager
def _page(collection: object, port: int, browser: bool) -> Iterator[None]:
    from server.calibrating.lens_run import Collection
    from server.calibrating.page import coverage_app
    from server.web_server import WebServer

    assert isinstance(collection, Collection)
    with WebServer(coverage_app(collection), port=port) as server:
        out.print(f"What is covered is shown at {server.url}", soft_wrap=True)
        if browser:
            webbrowser.open(server.url)
        yield


def _finish(result: "Result", place: Path, report: Path | None, *, as_json: bool, dry_run: bool) -> None:
    """Tell, keep and draw; end with 1 where nothing was good enough to keep."""
    if report is not None:
        from server.report import write_report

        err.print(f"agora: the figures are in {write_report(result.document(), report)}", soft_wrap=True)
    if result.sheets and not dry_run:
        result.keep(place)
    if as_json:
        out.print_json(json.dumps(result.as_json() | {"rig_file": None if dry_run else str(place)}))
    else:
        _print(result, place, dry_run)
    if not result.sheets:
        raise typer.Exit(1)


def _print(result: "Result", place: Path, dry_run: bool) -> None:
    for sentence in result.found:
        out.print(f"  {sentence}", soft_wrap=True, markup=False)
    for sentence in result.doubts:
        out.print(f"! {sentence}", soft_wrap=True, markup=False, style="yellow")
    if result.sheets and not dry_run:
        out.print(f"Kept in {place}: {', '.join(sorted(result.sheets))}.", soft_wrap=True, markup=False)
