"""What the tests need from the machine: a Chromium, OpenGL on EGL, a font, gpsd and HAProxy, found or, by root, installed.

`make test` runs this file before pytest. It says nothing and takes under two seconds where everything is there.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from rich.console import Console

BROWSER_NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome", "chrome")
GL_PACKAGES = ("libegl1", "libgl1", "libgl1-mesa-dri")
FONT_PACKAGES = ("fonts-dejavu-core", "fontconfig")
GPSD_PACKAGES = ("gpsd", "gpsd-clients", "python3-gps")
PROXY_PACKAGES = ("haproxy",)
DOWNLOAD_TIMEOUT_S = 150.0
"""Chromium is 170 MB: over a link slower than 10 Mbit/s the distribution's package is no slower."""
INSTALL_TIMEOUT_S = 400.0
OPEN_GL = "import moderngl; moderngl.create_standalone_context(backend='egl').release()"
ASK_PLAYWRIGHT = """
import sys
from playwright.sync_api import sync_playwright
with sync_playwright() as playwright:
    sys.stdout.write(playwright.chromium.executable_path)
"""


def succeeds(*command: str, timeout_s: float = 20.0) -> bool:
    """Return whether `command` ends with exit code 0 within `timeout_s`."""
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout_s, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0


def downloaded_browser() -> str | None:
    """Return where Playwright keeps its own Chromium, or None where it has downloaded none."""
    done = subprocess.run((sys.executable, "-c", ASK_PLAYWRIGHT), capture_output=True, text=True, check=False)
    path = done.stdout.strip()
    return path if path and Path(path).is_file() else None


def find_browser() -> str | None:
    """Return the path of a Chromium or Chrome that starts, or None. Ubuntu's `chromium-browser` may be a stub that does not."""
    on_path = [path for name in BROWSER_NAMES if (path := shutil.which(name))]
    for path in on_path:
        if succeeds(path, "--version"):
            return path
    own = downloaded_browser()
    return own if own and succeeds(own, "--version") else None


def has_open_gl() -> bool:
    """Return whether moderngl can draw off-screen; tried in a child, because a broken driver may end the process."""
    return succeeds(sys.executable, "-c", OPEN_GL)


def has_font() -> bool:
    """Return whether any outline font is installed: without one, Chromium draws no text, or none at all."""
    folders = (Path("/usr/share/fonts"), Path("/usr/local/share/fonts"), Path.home() / ".local/share/fonts")
    return any(path.suffix in {".ttf", ".otf", ".ttc", ".pfb"} for folder in folders for path in folder.rglob("*"))


def has_daemon(name: str) -> bool:
    """Return whether a program is there that may lie where only root's PATH looks."""
    return shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin") is not None


def has_gpsd() -> bool:
    """Return whether gpsd is there and `gpsfake`, which plays logs to it, starts."""
    return has_daemon("gpsd") and succeeds("gpsfake", "--version")


def is_root() -> bool:
    return os.geteuid() == 0


def install(*packages: str) -> bool:
    """Install Debian or Ubuntu `packages`; return whether that worked. The lists are renewed only when they are too old to do."""
    if not is_root() or shutil.which("apt-get") is None:
        return False
    command = (
        "env",
        "DEBIAN_FRONTEND=noninteractive",
        "apt-get",
        "install",
        "--yes",
        "--no-install-recommends",
        *packages,
    )
    if succeeds(*command, timeout_s=INSTALL_TIMEOUT_S):
        return True
    return succeeds("apt-get", "update", timeout_s=INSTALL_TIMEOUT_S) and succeeds(
        *command, timeout_s=INSTALL_TIMEOUT_S
    )


def get_browser(say: Console) -> bool:
    """Make sure of a browser: there already, else Playwright's download, else the distribution's package."""
    if find_browser():
        return True
    say.print("agora: fetching a Chromium for the tests")
    fetch = (sys.executable, "-m", "playwright", "install", "--no-shell", "chromium")
    if succeeds(*fetch, timeout_s=DOWNLOAD_TIMEOUT_S) and find_browser():
        return True
    return install("chromium") and find_browser() is not None


def get_open_gl(say: Console) -> bool:
    """Make sure that pictures can be drawn off-screen."""
    if has_open_gl():
        return True
    say.print("agora: installing OpenGL for the tests")
    return install(*GL_PACKAGES) and has_open_gl()


def get_font(say: Console) -> bool:
    """Make sure of a font."""
    if has_font():
        return True
    say.print("agora: installing a font for the tests")
    return install(*FONT_PACKAGES) and has_font()


def get_gpsd(say: Console) -> bool:
    """Make sure of gpsd."""
    if has_gpsd():
        return True
    say.print("agora: installing gpsd for the tests")
    return install(*GPSD_PACKAGES) and has_gpsd()


def get_proxy(say: Console) -> bool:
    """Make sure of HAProxy."""
    if has_daemon("haproxy"):
        return True
    say.print("agora: installing HAProxy for the tests")
    return install(*PROXY_PACKAGES) and has_daemon("haproxy")


def main() -> int:
    """Get what is missing; return 3 where root could not, and 0 otherwise: then the tests in question are skipped as "not root"."""
    say = Console(stderr=True, highlight=False, soft_wrap=True)
    needs = (
        (get_open_gl(say), "off-screen OpenGL", GL_PACKAGES),
        (get_font(say), "a font", FONT_PACKAGES),
        (get_browser(say), "a browser", ("chromium",)),
        (get_gpsd(say), "gpsd", GPSD_PACKAGES),
        (get_proxy(say), "HAProxy", PROXY_PACKAGES),
    )
    missing = [(what, packages) for there, what, packages in needs if not there]
    for what, packages in missing:
        say.print(f"agora: the tests need {what}: run as root: apt-get install {' '.join(packages)}")
    return 3 if missing and is_root() else 0


if __name__ == "__main__":
    sys.exit(main())
