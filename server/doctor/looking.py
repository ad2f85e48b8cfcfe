"""Looking at what is plugged in, at the calibration and at the machine. No judgement here, and nothing is changed."""

import os
import shutil
import sys
import urllib.error
import urllib.request
from collections.abc import Callable, Mapping
from pathlib import Path
from threading import Event

from assets.site import Site
from server.access import Access
from server.app import create_app
from server.doctor.facts import FoundDevices, MachineFacts, RigFileFacts
from server.errors import AddressUnavailable, PortInUse, ServerError
from server.site_facts import site_facts
from server.web_server import WebServer
from tracker.errors import InputError, SourceLost
from tracker.rig_file import DEFAULT_PLACE, read_rig_file
from tracker.sources.camera_devices import camera_devices
from tracker.sources.gpsd import DEFAULT_PORT, GpsdStream
from tracker.sources.phidget_devices import PhidgetDevice, phidget_devices, phidgets_on_usb
from tracker.sources.serial_devices import serial_devices

#: Those that draw WebGL 2, by the names of their programs.
BROWSERS = (
    *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "microsoft-edge", "brave-browser"),
    *("firefox", "firefox-esr", "epiphany", "falkon"),
)
_GPSD_READS = 5
_PAGE_S = 5.0


def found_devices() -> FoundDevices:
    """Return what is plugged in; takes a second."""
    phidgets: tuple[PhidgetDevice, ...] = ()
    trouble = None
    try:
        phidgets = phidget_devices()
    except InputError as error:
        trouble = str(error)
    return FoundDevices(phidgets, phidgets_on_usb(), trouble, serial_devices(), gpsd_here(), camera_devices())


def gpsd_here(port: int = DEFAULT_PORT) -> str | None:
    """Return what this machine's gpsd says of its receivers; None where there is none."""
    stream = GpsdStream("127.0.0.1", port)
    try:
        stream.open(Event())
        for _ in range(_GPSD_READS):
            stream.read()
        return stream.detail
    except SourceLost:
        return None
    finally:
        stream.close()


def rig_file_facts(path: Path | None) -> RigFileFacts:
    """Return what is known of the rig."""
    place, was_named = (DEFAULT_PLACE.expanduser(), False) if path is None else (path, True)
    if not was_named and not place.exists():
        return RigFileFacts(place, was_named)
    try:
        return RigFileFacts(place, was_named, read_rig_file(place))
    except InputError as error:
        return RigFileFacts(place, was_named, trouble=str(error))


def machine_facts(site: Site, web: Path, *, port: int, record: Path | None, browser: bool) -> MachineFacts:
    """Return how the machine is; starts the server for a moment and asks it for its page."""
    models = site.folder / "built"
    pages_built, models_built = (web / "ar.html").is_file(), any(models.glob("*.glb"))
    port_trouble, page_trouble = None, None
    server = None
    try:
        server = _server(site, web, port)
    except (PortInUse, AddressUnavailable) as error:
        port_trouble, server = str(error), _server(site, web, 0)
    try:
        with server:
            page_trouble = asked(f"{server.url}ar")
    except ServerError as error:
        page_trouble = str(error)
    folder, free_bytes, folder_trouble = room_in(Path.cwd() if record is None else record)
    return MachineFacts(
        port, port_trouble, browser_here(), has_screen(), browser, pages_built, models_built, page_trouble, folder,
        folder_trouble, free_bytes, record is not None,
    )  # fmt: skip


def _server(site: Site, web: Path, port: int) -> WebServer:
    models = site.folder / "built"
    app = create_app(web_folder=web, models_folder=models, site=site_facts(site, models), access=Access.for_loopback())
    return WebServer(app, "127.0.0.1", port)


def asked(url: str) -> str | None:
    """Ask for a page as a browser on this machine does, without a proxy; return what is wrong with the answer."""
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    try:
        with opener.open(url, timeout=_PAGE_S) as answer:
            is_page = b"<script" in answer.read()
    except (OSError, urllib.error.URLError) as error:
        return f"This machine's own server does not answer ({error}): is a firewall closed for 127.0.0.1?"
    return None if is_page else "The server's page is not what was built: run `make clean setup`."


def browser_here(
    which: Callable[[str], str | None] = shutil.which,
    environ: Mapping[str, str] = os.environ,
    system: str = sys.platform,
) -> str | None:
    """Return the browser that would open the page; None where there is none."""
    asked_for = environ.get("BROWSER", "").split(os.pathsep)[0]
    if asked_for:
        return asked_for
    if system != "linux":
        return "The system's browser"
    return next((name for name in BROWSERS if which(name)), None)


def has_screen(environ: Mapping[str, str] = os.environ, system: str = sys.platform) -> bool:
    """Return whether windows can be shown here."""
    return system != "linux" or bool(environ.get("DISPLAY") or environ.get("WAYLAND_DISPLAY"))


def room_in(folder: Path) -> tuple[Path, int, str | None]:
    """Return a folder, or the first of those above it that is there, how much is free in it, and why nothing can be written."""
    place = folder.expanduser().absolute()
    place = next((each for each in (place, *place.parents) if each.exists()), place)
    free_bytes = shutil.disk_usage(place).free
    if not place.is_dir() or not os.access(place, os.W_OK):
        return folder, free_bytes, f"Nothing can be written into {place}: name another folder with --record."
    return folder, free_bytes, None
