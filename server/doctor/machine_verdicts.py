"""What is said of the machine: its port, its pages, its browser, its disk. Pure: facts in, verdicts out."""

from collections.abc import Collection

from server.doctor.facts import MachineFacts, SensorFacts
from server.doctor.verdict import State, Verdict

GROUP = "This machine"
#: What sensors without a camera write in a second, as measured: 250 samples and their frames.
_PLAIN_BYTES_S = 60e3
#: A camera that was not heard writes about this much.
_USUAL_PICTURES_BYTES_S = 4e6
_SHORT_H, _TOO_SHORT_H = 2.0, 0.2


def machine_verdicts(facts: MachineFacts, sensors: Collection[SensorFacts]) -> list[Verdict]:
    """Return what is said of it."""
    return [_port(facts), _pages(facts), _browser(facts), _disk(facts, bytes_per_s(sensors))]


def bytes_per_s(sensors: Collection[SensorFacts]) -> float:
    """Return how much a recording grows each second."""
    camera = next((sensor for sensor in sensors if sensor.sensor == "camera"), None)
    if camera is None:
        return _PLAIN_BYTES_S
    if camera.picture is None:
        return _PLAIN_BYTES_S + _USUAL_PICTURES_BYTES_S
    return _PLAIN_BYTES_S + camera.picture.mean_bytes * camera.streams["Frame"].rate_hz


def _port(facts: MachineFacts) -> Verdict:
    figures = {"port": facts.port}
    if facts.port_trouble is not None:
        return Verdict(GROUP, "port", State.AMISS, facts.port_trouble, figures)
    sentence = f"Port {facts.port} is free." if facts.port else "A free port will be taken."
    return Verdict(GROUP, "port", State.WELL, sentence, figures)


def _pages(facts: MachineFacts) -> Verdict:
    missing = [what for what, built in (("pages", facts.pages_built), ("models", facts.models_built)) if not built]
    if missing:
        return Verdict(
            GROUP, "pages", State.AMISS, f"The {' and the '.join(missing)} are not built yet: run `make setup`."
        )
    if facts.page_trouble is not None:
        return Verdict(GROUP, "pages", State.AMISS, facts.page_trouble)
    return Verdict(GROUP, "pages", State.WELL, "Built, and this machine's server answers with them.")


def _browser(facts: MachineFacts) -> Verdict:
    figures = {"browser": facts.browser, "screen": facts.has_screen}
    if not facts.wants_browser:
        return Verdict(GROUP, "browser", State.ABSENT, "None was asked for.", figures)
    if facts.browser is None:
        sentence = "There is none: install one, for instance by `apt-get install chromium`, or give --no-browser."
        return Verdict(GROUP, "browser", State.AMISS, sentence, figures)
    if not facts.has_screen:
        sentence = (
            f"{facts.browser} has no screen here: give --no-browser, run `ssh -L {facts.port or 8470}:127.0.0.1:"
            f"{facts.port or 8470}` on a machine with one, and open the address there."
        )
        return Verdict(GROUP, "browser", State.AMISS, sentence, figures)
    return Verdict(GROUP, "browser", State.WELL, f"{facts.browser} will open the page.", figures)


def _disk(facts: MachineFacts, growth_bytes_s: float) -> Verdict:
    hours = facts.free_bytes / growth_bytes_s / 3600.0
    figures = {"folder": str(facts.folder), "free_bytes": facts.free_bytes, "hours": round(hours, 2)}
    if facts.folder_trouble is not None:
        return Verdict(GROUP, "disk", State.AMISS if facts.records else State.ABSENT, facts.folder_trouble, figures)
    words = f"{facts.free_bytes / 1e9:.1f} GB free in {facts.folder}, room for {_hours(hours)} of recording"
    if hours < _SHORT_H:
        state = State.AMISS if facts.records and hours < _TOO_SHORT_H else State.ADVICE
        return Verdict(GROUP, "disk", state, f"{words}: make room, or name another folder with --record.", figures)
    return Verdict(GROUP, "disk", State.WELL, f"{words}.", figures)


def _hours(hours: float) -> str:
    return f"{hours:,.0f} hours" if hours >= 1.0 else f"{hours * 60.0:.0f} minutes"
