"""`agora doctor`: the command."""

import json
import shlex
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from datetime import date
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.status import Status

from assets.site import Site
from server.live_commands import Camera, Gps, Imu, RecordFolder, RigPlace
from server.options import SITE, WEB, Browser, Port, SiteFolder, site_with
from server.terminal import terminal

if TYPE_CHECKING:
    from server.doctor.facts import FoundDevices, SensorFacts
    from server.doctor.verdict import Verdict
    from server.rig_sources import RigSources
    from tracker.rig_file import RigFile
    from tracker.sources.source import Source

out = terminal()
err = terminal(stderr=True)

#: A word in the names of the Phidgets that are a receiver and an inertial unit.
_PHIDGETS = {"gps": "GPS", "imu": "Spatial", "camera": "no camera"}
Seconds = Annotated[float, typer.Option("--seconds", min=0.5, max=600.0, help="How long to measure rates.")]


def doctor(
    gps: Gps = "phidget",
    imu: Imu = "phidget",
    camera: Camera = "0",
    rig: RigPlace = None,
    record: RecordFolder = None,
    port: Port = 8470,
    browser: Browser = True,
    seconds: Seconds = 5.0,
    site: SiteFolder = SITE,
    as_json: Annotated[bool, typer.Option("--json", help="All figures as JSON.")] = False,
) -> None:
    """Look at all that `agora walk` with the same options needs: each is well, or what to do is said. Exit code 0 or 1."""
    # imported here, so that `agora rules` need not wait for a web server
    from server.doctor import page
    from server.doctor.verdict import all_is_well

    asked = {"gps": gps, "imu": imu, "camera": camera}
    verdicts = _verdicts(asked, rig, seconds, site_with(site, None), port=port, record=record, browser=browser)
    if as_json:
        out.print_json(json.dumps(page.as_json(verdicts, asked)))
    else:
        options = {**asked, **({} if rig is None else {"rig": rig}), **({} if record is None else {"record": record})}
        words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
        out.print(page.page(verdicts, shlex.join(["agora", "walk", *words])))
    raise typer.Exit(0 if all_is_well(verdicts) else 1)


def _verdicts(
    asked: Mapping[str, str],
    rig: Path | None,
    seconds: float,
    site: Site,
    *,
    port: int,
    record: Path | None,
    browser: bool,
) -> list["Verdict"]:
    """Look at everything, then judge it."""
    from server.doctor.looking import found_devices, machine_facts, rig_file_facts
    from server.doctor.machine_verdicts import machine_verdicts
    from server.doctor.rig_verdicts import calibration_verdicts, found_verdicts
    from server.doctor.sensor_verdicts import sensor_verdicts

    calibration = rig_file_facts(rig)
    with err.status("looking …") if err.is_terminal else nullcontext() as status:
        with ThreadPoolExecutor(1) as beside:
            found_later = beside.submit(found_devices)
            machine = machine_facts(site, WEB, port=port, record=record, browser=browser)
            found = found_later.result()
        # nothing else runs now: pauses of a sensor are then its own
        sensors = _listen(asked, calibration.rig_file, found, seconds, status)
    return [
        *(verdict for facts in sensors for verdict in sensor_verdicts(facts, found, calibration.rig_file)),
        *calibration_verdicts(calibration, sensors, date.today()),
        *machine_verdicts(machine, sensors),
        *found_verdicts(found, asked.values()),
    ]


def _listen(
    asked: Mapping[str, str], rig_file: "RigFile | None", found: "FoundDevices", seconds: float, status: Status | None
) -> list["SensorFacts"]:
    from server.doctor.listening import Wanted, listen
    from server.doctor.sensor_verdicts import TITLES
    from server.rig_sources import RigSources
    from tracker.rig_file import RigFile

    makers, wanted = RigSources(rig_file or RigFile()), []
    for sensor, spec in asked.items():
        if spec != "none":
            is_there = spec.startswith("phidget") and found.has_phidget(_PHIDGETS[sensor])
            wanted.append(Wanted(sensor, spec, partial(_source, makers, sensor, spec), is_there))
    titles = " and ".join(TITLES[each.sensor] for each in wanted)

    def progress(so_far_s: float) -> None:
        if status is not None:
            status.update(f"listening to {titles}, {so_far_s:.0f} s")

    return listen(wanted, seconds, progress)


def _source(makers: "RigSources", sensor: str, spec: str) -> "Source":
    """Return one source; what is amiss with it must not hide what is amiss with others."""
    specs = {"gps": "none", "imu": "none", "camera": "none", sensor: spec}
    return makers.make(gps=specs["gps"], imu=specs["imu"], camera=specs["camera"])[0]
