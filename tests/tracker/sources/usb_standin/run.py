"""`agora` with two Phidgets plugged in that are not there, in one process, for tests from end to end.

    python -m tests.tracker.sources.usb_standin.run WALK [--library FILE] [--control FILE] -- agora walk ...

WALK is a log (MCAP) whose inertial samples, magnetic field and fixes the devices say, or `simulate:SEED:SECONDS`. It begins when
the program has opened both devices. Lines appended to the control file are obeyed within 20 ms: `unplug gps`, `plug gps`,
`unplug imu`, `plug imu`, `nofix`, `fix`, `freeze`, `thaw`; what the walker does goes to standard error.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from threading import Event, Thread

from tests.tracker.sources.usb_standin.bus import Bus, build
from tests.tracker.sources.usb_standin.walker import Walker
from tracker.log import Log
from tracker.measurements import Measurement
from tracker.simulate import Walk, WalkSettings, default_rig, simulate

_LOOK_UP_S = 0.02


def measurements(walk: str) -> Iterator[Measurement]:
    """Yield what a walk's sensors say: of a log's path, or of `simulate:SEED:SECONDS`."""
    kind, _, settings = walk.partition(":")
    if kind == "simulate":
        seed, seconds = settings.split(":")
        return simulate(Walk(WalkSettings(seed=int(seed), duration_s=float(seconds)), default_rig()))
    return Log.open(Path(walk)).messages(camera=False, truth=False)


def obey(walker: Walker, control: Path, stop: Event) -> None:
    """Do what is written into the control file, line by line, until told to stop."""
    control.touch()
    with control.open(encoding="utf-8") as lines:
        written = ""
        while not stop.wait(_LOOK_UP_S):
            written += lines.readline()
            if written.endswith("\n"):
                say(written.strip())
                walker.do(written)
                written = ""


def announce(walker: Walker) -> None:
    """Say when the walk begins and when it ends."""
    walker.walking.wait()
    say("walking")
    walker.ended.wait()
    say("at the end of the walk")


def say(what: str) -> None:
    """Write one line to standard error."""
    print(f"usb stand-in: {what}", file=sys.stderr, flush=True)  # noqa: T201


def main() -> None:
    """Plug the devices in, then run `agora` in this thread."""
    arguments, command = sys.argv[1:], []
    if "--" in arguments:
        i = arguments.index("--")
        arguments, command = arguments[:i], arguments[i + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("walk")
    parser.add_argument("--library", type=Path, help="the stand-in, built; it is built anew without")
    parser.add_argument("--control", type=Path, help="the file that commands are appended to")
    options = parser.parse_args(arguments)
    if command[:1] != ["agora"]:
        parser.error("after -- comes: agora COMMAND ...")
    with tempfile.TemporaryDirectory() as folder:
        walker = Walker(Bus(options.library or build(Path(folder))), measurements(options.walk))
        walker.start()
        Thread(target=announce, args=(walker,), daemon=True).start()
        if options.control is not None:
            Thread(target=obey, args=(walker, options.control, Event()), daemon=True).start()
        sys.argv = command
        from server.cli import main as agora

        agora()


if __name__ == "__main__":
    main()
