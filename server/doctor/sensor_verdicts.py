"""What is said of a sensor that was listened to. Pure: facts in, verdicts out."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from server.doctor.facts import FoundDevices, SensorFacts, Stream
from server.doctor.verdict import State, Verdict
from tracker.rig_file import RigFile
from tracker.running.health import KINDS

GROUP = "Sensors"
TITLES = {"gps": "GPS receiver", "imu": "inertial unit", "camera": "camera"}

#: A receiver says its place once a second; a little less is a clock, not a fault.
_LEAST_FIXES_HZ = 0.9
#: Dilution beyond which a place is a guess.
_POOR_HDOP = 5.0
#: The paper's rig had 100 samples a second and more; below this a turning head is not followed.
_LEAST_SAMPLES_HZ, _LONGEST_PAUSE_S = 80.0, 0.1
#: Gravity with the scale errors of an uncalibrated unit, and a hand that trembles.
_GRAVITY_M_S2 = (9.5, 10.1)
#: Vision is to estimate ten times a second; a little less is a clock, not a fault.
_LEAST_PICTURES_HZ, _MUCH_SLOWER = 9.5, 0.7
_BLACK, _WHITE = 8.0, 247.0
#: The receiver's time of day comes up to two seconds late.
_TIME_OF_DAY_S = 5.0
#: The aspect ratios of a lens and its pictures are the same when they differ by less.
_SAME_SHAPE = 0.01


def sensor_verdicts(facts: SensorFacts, found: FoundDevices, rig_file: RigFile | None) -> list[Verdict]:
    """Return what is said of one sensor, most important first."""
    title, status = TITLES[facts.sensor], facts.status
    if not facts.streams:
        trouble = facts.trouble or f"{_detail(facts)} says nothing: {KINDS[facts.sensor].silent_remedy}."
        sentence = f"{trouble.rstrip('.')}.{_instead(facts, found)}"
        return [Verdict(GROUP, title, State.AMISS, sentence, {"asked": facts.spec})]
    told = {"asked": facts.spec, "counts": dict(status.counts) if status else {}}
    if facts.trouble is not None:
        first = Verdict(GROUP, title, State.AMISS, f"It went away while it was listened to: {facts.trouble}", told)
    else:
        first = Verdict(GROUP, title, State.WELL, f"{_detail(facts)}.", told)
    judges: Mapping[str, Callable[[], Iterator[Verdict]]] = {
        "gps": lambda: _gps(facts),
        "imu": lambda: _imu(facts),
        "camera": lambda: _camera(facts, rig_file),
    }
    return [first, *(replace(verdict, name=title, part=verdict.name) for verdict in judges[facts.sensor]())]


def _detail(facts: SensorFacts) -> str:
    detail = "" if facts.status is None else facts.status.detail.rstrip(".")
    return detail or f"The {TITLES[facts.sensor]}"


def _instead(facts: SensorFacts, found: FoundDevices) -> str:
    """Return a sentence on what is plugged in and might be meant; with a space before it."""
    is_phidget = facts.spec.partition(":")[0] == "phidget"
    if is_phidget and found.phidgets_on_usb > len(found.phidgets):
        return ""  # said under what was found
    if facts.sensor != "gps":
        return ""
    others = [f"--gps serial:{port.path}" for port in found.serial_ports if port.is_usb]
    others += ["--gps gpsd"] if found.gpsd is not None else []
    others += ["--gps phidget"] if found.has_phidget("GPS") else []
    others = [other for other in others if other.split()[1] != facts.spec]
    return f" Or take what is plugged in: {' or '.join(others)}." if others else ""


def _said(facts: SensorFacts) -> Mapping[str, Any]:
    return {} if facts.status is None else facts.status.facts


def _stream(facts: SensorFacts, kind: str) -> Stream:
    return facts.streams.get(kind, Stream())


def _figures(stream: Stream) -> dict[str, object]:
    return {
        "count": stream.count,
        "rate_hz": round(stream.rate_hz, 2),
        "longest_pause_s": round(stream.longest_pause_s, 4),
        "delay_ms": round(stream.delay_s * 1e3, 2),
    }


# -- the receiver -----------------------------------------------------------------------------------------------------


def _gps(facts: SensorFacts) -> Iterator[Verdict]:
    fixes, velocities = _stream(facts, "GpsFix"), _stream(facts, "GpsVelocity")
    figures = {"fixes": _figures(fixes), "velocities": _figures(velocities)}
    rate = f"{fixes.rate_hz:.1f} epochs a second, {velocities.rate_hz:.1f} velocities"
    if fixes.rate_hz < _LEAST_FIXES_HZ:
        state, sentence = State.AMISS, f"Only {rate}: set the receiver to one a second or more."
    elif facts.valid_fixes and not velocities.count:
        state, sentence = State.ADVICE, f"{rate}: switch RMC or VTG on, by which the heading is found."
    else:
        state, sentence = State.WELL, f"{rate}."
    yield Verdict(GROUP, "rate", state, sentence, figures)
    yield _fix(facts)
    yield from _gps_clock(facts)


def _fix(facts: SensorFacts) -> Verdict:
    said = _said(facts)
    in_view = said.get("satellites")
    figures = {key: said.get(key) for key in ("fix", "hdop", "satellites_used", "satellites")}
    figures["valid_fixes"] = facts.valid_fixes
    if not facts.valid_fixes:
        seen = f", with {len(in_view)} satellites in view" if in_view else ""
        sentence = f"It has no fix{seen}: it needs open sky, and up to a minute after it was switched on."
        return Verdict(GROUP, "fix", State.AMISS, sentence, figures)
    words = [str(said.get("fix") or "a fix")]
    if (used := said.get("satellites_used")) is not None:
        words.append(f"{used} satellites used" + (f" of {len(in_view)} in view" if in_view else ""))
    if (hdop := said.get("hdop")) is not None:
        words.append(f"HDOP {hdop:.1f}")
    sentence = ", ".join(words)
    sentence = sentence[:1].upper() + sentence[1:]
    if hdop is not None and hdop > _POOR_HDOP:
        return Verdict(GROUP, "fix", State.ADVICE, f"{sentence}: go where more of the sky is seen.", figures)
    return Verdict(GROUP, "fix", State.WELL, f"{sentence}.", figures)


def _gps_clock(facts: SensorFacts) -> Iterator[Verdict]:
    said, delay_s = _said(facts), _stream(facts, "GpsFix").delay_s
    figures = {key: said[key] for key in ("clock_drift_ppm", "clock_resets") if key in said}
    figures |= {"delay_ms": round(delay_s * 1e3, 1), "time_of_day_offset_s": _rounded(facts.utc_offset_s)}
    offset_s = facts.utc_offset_s
    if offset_s is not None and abs(offset_s) > _TIME_OF_DAY_S:
        way = "ahead of" if offset_s > 0.0 else "behind"
        sentence = (
            f"This machine's time of day is {_words(abs(offset_s))} {way} the receiver's, and recordings are dated by it: set it, "
            "for instance by `timedatectl set-ntp true`."
        )
        yield Verdict(GROUP, "clock", State.ADVICE, sentence, figures)
        return
    yield _clock(facts, delay_s, figures)


def _words(time_s: float) -> str:
    return f"{time_s:.0f} s" if time_s < 120.0 else f"{time_s / 60.0:,.0f} minutes"


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 1)


def _clock(facts: SensorFacts, delay_s: float, figures: Mapping[str, object]) -> Verdict:
    said = _said(facts)
    if said.get("clock_resets"):
        sentence = "Its clock leaps while it runs: pull it out and put it back, and charge or change its battery if it has one."
        return Verdict(GROUP, "clock", State.AMISS, sentence, figures)
    drift = f", its clock drifts by {said['clock_drift_ppm']:.0f} ppm" if "clock_drift_ppm" in said else ""
    return Verdict(GROUP, "clock", State.WELL, f"Arrives {delay_s * 1e3:.1f} ms after it was measured{drift}.", figures)


# -- the inertial unit ------------------------------------------------------------------------------------------------


def _imu(facts: SensorFacts) -> Iterator[Verdict]:
    samples, field = _stream(facts, "ImuSample"), _stream(facts, "MagSample")
    words = f"{samples.rate_hz:.0f} samples a second, at most {samples.longest_pause_s * 1e3:.0f} ms apart"
    remedy = "plug it into this machine itself, not through a hub, and end other programs that use it"
    if samples.rate_hz < _LEAST_SAMPLES_HZ:
        yield Verdict(GROUP, "rate", State.AMISS, f"Only {words}: {remedy}.", _figures(samples))
    elif samples.longest_pause_s > _LONGEST_PAUSE_S:
        yield Verdict(GROUP, "rate", State.ADVICE, f"{words}: {remedy}.", _figures(samples))
    else:
        yield Verdict(GROUP, "rate", State.WELL, f"{words}.", _figures(samples))
    if field.count:
        yield Verdict(GROUP, "compass", State.WELL, f"{field.rate_hz:.0f} readings a second.", _figures(field))
    else:
        sentence = "It tells no magnetic field: walk ten steps straight ahead at the start, by which north is found."
        yield Verdict(GROUP, "compass", State.ADVICE, sentence, _figures(field))
    yield _gravity(facts)
    said = _said(facts)
    figures = {key: said[key] for key in ("clock_offset_ns", "clock_drift_ppm", "clock_resets") if key in said}
    yield _clock(facts, samples.delay_s, {**figures, "delay_ms": round(samples.delay_s * 1e3, 2)})


def _gravity(facts: SensorFacts) -> Verdict:
    force_m_s2 = facts.specific_force_m_s2 or 0.0
    figures = {"specific_force_m_s2": round(force_m_s2, 3)}
    words = f"{force_m_s2:.2f} m/s² on average"
    if _GRAVITY_M_S2[0] <= force_m_s2 <= _GRAVITY_M_S2[1]:
        return Verdict(GROUP, "gravity", State.WELL, f"{words}.", figures)
    sentence = f"{words}, where gravity is 9.8: lay it down, look again, and if it stays run `agora calibrate imu`."
    return Verdict(GROUP, "gravity", State.ADVICE, sentence, figures)


# -- the camera -------------------------------------------------------------------------------------------------------


def _camera(facts: SensorFacts, rig_file: RigFile | None) -> Iterator[Verdict]:
    yield _mode(facts, rig_file)
    yield _pictures(facts)
    yield _brightness(facts)
    yield _stamps(facts, rig_file)


def _mode(facts: SensorFacts, rig_file: RigFile | None) -> Verdict:
    said, picture = _said(facts), facts.picture
    figures = {k: said.get(k) for k in ("device", "serial", "backend", "codec", "rate_hz", "exposure_s")}
    if picture is None:
        sentence = "Its pictures do not decode: plug it out and in again, or choose another camera."
        return Verdict(GROUP, "mode", State.AMISS, sentence, figures)
    figures |= {
        "width_px": picture.width_px,
        "height_px": picture.height_px,
        "picture_bytes": round(picture.mean_bytes),
    }
    rate = f" at {said['rate_hz']:.0f} a second" if said.get("rate_hz") else ""
    words = f"{said.get('codec') or 'Pictures'} {picture.width_px}x{picture.height_px}{rate}"
    if said.get("exposure_s"):
        words += f", exposed for {said['exposure_s'] * 1e3:.0f} ms"
    lens = None if rig_file is None else rig_file.camera
    if lens is not None:
        ratio = picture.width_px * lens.height_px / (picture.height_px * lens.width_px)
        if abs(ratio - 1.0) > _SAME_SHAPE:
            sentence = (
                f"{words}, and its lens was calibrated at {lens.width_px}x{lens.height_px}, another shape: "
                "run `agora calibrate camera` anew."
            )
            return Verdict(GROUP, "mode", State.AMISS, sentence, figures)
    return Verdict(GROUP, "mode", State.WELL, f"{words}.", figures)


def _pictures(facts: SensorFacts) -> Verdict:
    frames, promised_hz = _stream(facts, "Frame"), _said(facts).get("rate_hz") or 0.0
    words = f"{frames.rate_hz:.1f} pictures a second"
    remedy = "in the dark cameras slow down, so make light; and give it a USB port of its own"
    if frames.rate_hz < _LEAST_PICTURES_HZ:
        return Verdict(GROUP, "rate", State.AMISS, f"Only {words}: {remedy}.", _figures(frames))
    if frames.rate_hz < _MUCH_SLOWER * promised_hz:
        sentence = f"{words} of the {promised_hz:.0f} promised: {remedy}."
        return Verdict(GROUP, "rate", State.ADVICE, sentence, _figures(frames))
    return Verdict(GROUP, "rate", State.WELL, f"{words}.", _figures(frames))


def _brightness(facts: SensorFacts) -> Verdict:
    brightness = 0.0 if facts.picture is None else facts.picture.brightness
    figures = {"brightness": round(brightness, 1)}
    if brightness < _BLACK:
        return Verdict(GROUP, "picture", State.AMISS, "It is black: uncover the lens, or make light.", figures)
    if brightness > _WHITE:
        return Verdict(GROUP, "picture", State.AMISS, "It is white: shade the lens, or let it expose itself.", figures)
    return Verdict(GROUP, "picture", State.WELL, f"Its mean brightness is {brightness / 2.55:.0f} %.", figures)


def _stamps(facts: SensorFacts, rig_file: RigFile | None) -> Verdict:
    stamps, delay_s = _said(facts).get("stamps"), _stream(facts, "Frame").delay_s
    figures = {"stamps": stamps, "delay_ms": round(delay_s * 1e3, 1)}
    words = f"Arrives {delay_s * 1e3:.0f} ms after it was taken"
    if stamps != "read":
        by = {"driver": ", as its driver tells", "stream": ", by the stream's own times"}.get(str(stamps), "")
        return Verdict(GROUP, "clock", State.WELL, f"{words}{by}.", figures)
    if rig_file is not None and rig_file.camera_mount is not None:
        shift_ms = rig_file.camera_mount.time_offset_s * 1e3
        sentence = f"It does not tell when a picture was taken; the calibration does: {shift_ms:+.0f} ms."
        return Verdict(GROUP, "clock", State.WELL, sentence, figures)
    sentence = "It does not tell when a picture was taken, which is guessed: `agora calibrate rig` measures it."
    return Verdict(GROUP, "clock", State.ADVICE, sentence, figures)
