"""`agora calibrate mag`: a magnetometer that is turned through all directions, judged by the World Magnetic Model."""

from collections.abc import Sequence
from datetime import UTC, datetime

import numpy as np

from server.calibrating.feed import Feed, Progress
from server.calibrating.result import Result, today
from server.plots.field import field_pictures
from server.plots.style import Picture
from tracker.calibrate.magnetometer import LEAST_COVERAGE, MagFit, fit_magnetometer
from tracker.errors import InputError
from tracker.geomagnetism import MagneticField, magnetic_field
from tracker.measurements import GpsFix, ImuSample, MagSample, Matrix
from tracker.rig_sheets import MagSheet

#: A stamp before this is of no clock of the day: a live one counts from the start of the machine.
_FIRST_DAY_NS = 1_000_000_000 * 86_400 * 365 * 20
#: Measured and expected dip may differ by so much: the model's own error, and a table of steel nearby.
LARGEST_DIP_ERROR_RAD = np.radians(6.0)

Place = tuple[float, float]
"""Latitude and longitude, degrees."""


def calibrate_mag(feed: Feed, place: Place | None, progress: Progress) -> Result:
    """Return the rig's own iron.

    Raises:
        InputError: Too few directions, or a field that is not the Earth's; with the remedy.
    """
    R_body_imu = feed.rig.T_body_imu[:3, :3]
    samples: list[MagSample] = []
    inertial: list[ImuSample] = []
    for measurement in feed.measurements(progress):
        if isinstance(measurement, MagSample):
            samples.append(_turned(measurement, R_body_imu))
        elif isinstance(measurement, ImuSample):
            inertial.append(_turned_imu(measurement, R_body_imu))
    if not samples:
        raise InputError("There is no magnetometer in this: name a sensor that has one, or a log with /imu/mag.")
    expected, where = _expected(feed.first_fix(), place)
    fit = fit_magnetometer(samples, expected, inertial)
    return _result(fit, samples, feed, expected, where)


def _turned(sample: MagSample, R_body_imu: Matrix) -> MagSample:
    x, y, z = (np.array(sample.field_body_t) @ R_body_imu).tolist()
    return MagSample(sample.t_ns, sample.t_recv_ns, (x, y, z))


def _turned_imu(sample: ImuSample, R_body_imu: Matrix) -> ImuSample:
    x, y, z = (np.array(sample.accel_m_s2) @ R_body_imu).tolist()
    return ImuSample(sample.t_ns, sample.t_recv_ns, sample.gyro_rad_s, (x, y, z))


def _expected(fix: GpsFix | None, place: Place | None) -> tuple[MagneticField | None, str]:
    """Return the model's field and where that is; None where nobody says where the rig is."""
    if place is None and fix is None:
        return None, ""
    t_ns = fix.t_ns if fix is not None and fix.t_ns > _FIRST_DAY_NS else round(datetime.now(UTC).timestamp() * 1e9)
    lat_deg, lon_deg = place if place is not None else (fix.lat_deg, fix.lon_deg) if fix is not None else (0.0, 0.0)
    field = magnetic_field(lat_deg, lon_deg, 0.0, t_ns)
    return (
        field,
        f"{abs(lat_deg):.2f} {'N' if lat_deg >= 0 else 'S'}, {abs(lon_deg):.2f} {'E' if lon_deg >= 0 else 'W'}",
    )


def _result(
    fit: MagFit, samples: Sequence[MagSample], feed: Feed, expected: MagneticField | None, where: str
) -> Result:
    device, serial = feed.device("imu")
    x, y, z = fit.hard_iron_t.tolist()
    sheet = MagSheet(
        date=today(),
        device=device,
        serial=serial,
        hard_iron_t=(x, y, z),
        soft_iron=tuple(tuple(row) for row in fit.soft_iron.tolist()),
        strength_t=fit.strength_t,
        residual=round(fit.residual, 5),
        coverage=round(fit.coverage, 3),
        place=where,
    )
    stretch = np.linalg.eigvalsh(fit.soft_iron)
    found = [
        f"The rig's own field is {', '.join(f'{value * 1e6:.1f}' for value in fit.hard_iron_t)} µT (taken off), and its iron "
        f"stretches the Earth's by {100.0 * (stretch[-1] / stretch[0] - 1.0):.1f} % (put right).",
        f"After that the field's strength spreads by {100.0 * fit.residual:.1f} %: {fit.verdict}.",
        f"{fit.coverage:.0%} of all directions were seen (at least {LEAST_COVERAGE:.0%} is asked for).",
    ]
    doubts: list[str] = []
    numbers = {
        "hard_iron_t": fit.hard_iron_t.tolist(),
        "soft_iron": fit.soft_iron.tolist(),
        "strength_t": fit.strength_t,
        "measured_t": fit.measured_t,
        "residual": fit.residual,
        "coverage": fit.coverage,
        "dip_deg": None if fit.dip_rad is None else float(np.degrees(fit.dip_rad)),
        "expected": None
        if expected is None
        else {
            "strength_t": expected.strength_t,
            "dip_deg": float(np.degrees(expected.inclination_rad)),
            "declination_deg": float(np.degrees(expected.declination_rad)),
        },
        "verdict": fit.verdict,
    }
    if expected is None:
        found.append("Nobody says where this is (`--place LAT,LON`, or a receiver): the sensor's own scale is kept.")
    else:
        found += _against_model(fit, expected, where)
        if fit.dip_rad is not None and abs(fit.dip_rad - expected.inclination_rad) > LARGEST_DIP_ERROR_RAD:
            doubts.append(
                f"The field dips by {np.degrees(fit.dip_rad):.1f} degrees, not {np.degrees(expected.inclination_rad):.1f}: nothing "
                "was kept. Iron nearby bends it, or the magnetometer's axes are not the accelerometer's: go into the open."
            )

    def pictures() -> Sequence[Picture]:
        return field_pictures(fit, samples)

    return Result("magnetometer", {} if doubts else {"mag": sheet}, found, doubts, numbers, pictures)


def _against_model(fit: MagFit, expected: MagneticField, where: str) -> list[str]:
    ratio = 100.0 * (fit.measured_t / expected.strength_t - 1.0)
    words = [
        f"At {where} the World Magnetic Model has {expected.strength_t * 1e6:.1f} µT; the sensor shows "
        f"{fit.measured_t * 1e6:.1f} ({ratio:+.1f} %, put right)."
    ]
    if fit.dip_rad is not None and fit.dip_spread_rad is not None:
        words.append(
            f"The field dips by {np.degrees(fit.dip_rad):.1f} ± {np.degrees(fit.dip_spread_rad):.1f} degrees, by the model "
            f"{np.degrees(expected.inclination_rad):.1f}."
        )
    words.append(f"Magnetic north is {np.degrees(expected.declination_rad):+.2f} degrees east of true north there.")
    return words
