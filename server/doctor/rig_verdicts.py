"""What is said of the calibration and of what is plugged in. Pure: facts in, verdicts out."""

from collections.abc import Collection, Iterator, Mapping
from datetime import date
from typing import Any

from server.doctor.facts import FoundDevices, RigFileFacts, SensorFacts
from server.doctor.verdict import State, Verdict

CALIBRATION, FOUND = "Calibration", "Plugged in"
#: Which sensor a table is of, the command that makes it, what it is of, and after how many days it should be made anew.
_TABLES: Mapping[str, tuple[str, str, str, int]] = {
    "camera": ("camera", "camera", "lens", 365),
    "camera_mount": ("camera", "rig", "camera mount", 180),
    "imu": ("imu", "imu", "inertial unit", 30),
    "mag": ("imu", "mag", "magnetometer", 30),
}


def calibration_verdicts(facts: RigFileFacts, sensors: Collection[SensorFacts], today: date) -> list[Verdict]:
    """Return what is said of the rig file, as far as it is of sensors that were asked for."""
    where = {"path": str(facts.path)}
    if facts.trouble is not None:
        return [Verdict(CALIBRATION, "rig file", State.AMISS, facts.trouble, where)]
    # what is played from a recording is calibrated, and its rig is the recording's own
    by_name = {sensor.sensor: sensor for sensor in sensors if not sensor.spec.startswith("log:")}
    if facts.rig_file is None:
        steps = [f"`agora calibrate {command}`" for sensor, command, _, _ in _TABLES.values() if sensor in by_name]
        if not steps:
            return [Verdict(CALIBRATION, "rig file", State.ABSENT, f"There is no {facts.path}.", where)]
        sentence = f"There is no {facts.path}: run {', '.join(steps)}, and the square fits the ruins."
        return [Verdict(CALIBRATION, "rig file", State.ADVICE, sentence, where)]
    verdicts = [Verdict(CALIBRATION, "rig file", State.WELL, f"{facts.path} reads.", where)]
    for name, (sensor, *_) in _TABLES.items():
        if sensor in by_name:
            verdicts.append(_table(name, getattr(facts.rig_file, name), by_name[sensor], today))
    return verdicts


def _table(name: str, sheet: Any, sensor: SensorFacts, today: date) -> Verdict:
    _, command, what, most_days = _TABLES[name]
    run = f"run `agora calibrate {command}`"
    if sheet is None:
        return Verdict(CALIBRATION, what, State.ADVICE, f"It is not known: {run}.")
    days = (today - sheet.date).days
    figures = {"date": sheet.date.isoformat(), "age_days": days, "device": sheet.device, "serial": sheet.serial}
    if (other := _other_device(sheet, sensor)) is not None:
        sentence = (
            f"It was found with {sheet.device or sheet.serial}, and this is {other}: {run} anew, or name another --rig."
        )
        return Verdict(CALIBRATION, what, State.AMISS, sentence, figures)
    if days > most_days:
        return Verdict(CALIBRATION, what, State.ADVICE, f"It is {days} days old: {run} anew.", figures)
    return Verdict(CALIBRATION, what, State.WELL, f"Of {sheet.date.isoformat()}, {_ago(days)}.", figures)


def _other_device(sheet: Any, sensor: SensorFacts) -> str | None:
    """Return what is plugged in, where a table is of something else of the same kind."""
    if sensor.status is None or not sensor.streams:
        return None
    if sensor.sensor == "camera":
        serial, device = str(sensor.status.facts.get("serial") or ""), str(sensor.status.facts.get("device") or "")
        return f"{device}, {serial}" if serial and sheet.serial and serial != sheet.serial else None
    device = sensor.status.detail  # a Phidget's has its serial number in it
    is_other = sensor.spec.startswith("phidget") and "serial number" in sheet.device and device != sheet.device
    return device if is_other else None


def _ago(days: int) -> str:
    return {0: "today", 1: "yesterday"}.get(days, f"{days} days ago" if days > 0 else "a day that is yet to come")


def found_verdicts(found: FoundDevices, asked: Collection[str]) -> list[Verdict]:
    """Return what is plugged in; `asked` are the words by which sensors were asked for."""
    wants_phidget = any(spec.partition(":")[0] == "phidget" for spec in asked)
    return [_phidgets(found, wants_phidget), *_others(found)]


def _phidgets(found: FoundDevices, is_asked: bool) -> Verdict:
    figures = {"devices": [{"name": d.name, "serial": d.serial} for d in found.phidgets], "usb": found.phidgets_on_usb}
    amiss = State.AMISS if is_asked else State.ABSENT
    if found.phidget_trouble is not None:
        return Verdict(FOUND, "Phidgets", amiss, found.phidget_trouble, figures)
    names = [f"{device.name}, serial number {device.serial}" for device in found.phidgets]
    if found.phidgets_on_usb > len(found.phidgets):
        sentence = (
            f"{found.phidgets_on_usb} on the USB, and {len(names)} that may be opened: copy Phidgets' udev rule "
            "(99-libphidget22.rules) to /etc/udev/rules.d and plug them in anew."
        )
        return Verdict(FOUND, "Phidgets", amiss, sentence, figures)
    return _list("Phidgets", names, figures)


def _others(found: FoundDevices) -> Iterator[Verdict]:
    ports = [f"{port.path} ({port.name})" if port.name else port.path for port in found.serial_ports]
    yield _list("serial ports", ports, {"ports": [{"path": p.path, "name": p.name} for p in found.serial_ports]})
    yield _list("gpsd", [] if found.gpsd is None else [found.gpsd], {"gpsd": found.gpsd})
    cameras = [f"{camera.path} ({camera.name})" for camera in found.cameras]
    yield _list("cameras", cameras, {"cameras": [{"path": c.path, "name": c.name} for c in found.cameras]})


def _list(name: str, items: list[str], figures: Mapping[str, object]) -> Verdict:
    state = State.WELL if items else State.ABSENT
    return Verdict(FOUND, name, state, f"{'; '.join(items)}." if items else "None.", figures)
