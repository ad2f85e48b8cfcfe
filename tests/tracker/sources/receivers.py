"""NMEA receivers of our own making: the same walk, said in the ways in which receivers differ."""

import struct
from dataclasses import dataclass
from functools import reduce
from math import degrees
from operator import xor

import numpy as np

MS = 1_000_000
SECOND = 1000 * MS


def sentence(content: str, end: bytes = b"\r\n") -> bytes:
    """Return a whole sentence."""
    data = content.encode("latin-1")
    return b"$%s*%02X%s" % (data, reduce(xor, data, 0), end)


@dataclass(frozen=True)
class Moment:
    """What a receiver knows at one moment."""

    utc_s: float
    """Seconds of the day; from 86400 on, of the next one."""
    lat_deg: float = 37.9366
    lon_deg: float = 27.3447
    h_msl_m: float | None = 48.0
    separation_m: float | None = 38.5
    quality: int = 1
    hdop: float = 0.9
    speed_m_s: float = 1.4
    heading_deg: float | None = 45.0
    date: str = "280826"

    @property
    def _time(self) -> str:
        hundredths = round(self.utc_s * 100) % 8_640_000
        minutes, rest = divmod(hundredths, 6000)
        return f"{minutes // 60:02d}{minutes % 60:02d}{rest / 100:05.2f}"

    @property
    def _place(self) -> str:
        if self.quality == 0:
            return ",,,"
        lat_min, lon_min = abs(self.lat_deg) % 1 * 60, abs(self.lon_deg) % 1 * 60
        lat = f"{int(abs(self.lat_deg)):02d}{lat_min:010.7f},{'S' if self.lat_deg < 0 else 'N'}"
        return f"{lat},{int(abs(self.lon_deg)):03d}{lon_min:010.7f},{'W' if self.lon_deg < 0 else 'E'}"

    @property
    def _motion(self) -> tuple[str, str]:
        return f"{self.speed_m_s * 3600 / 1852:.4f}", "" if self.heading_deg is None else f"{self.heading_deg:.2f}"

    def gga(self, talker: str = "GN") -> bytes:
        height = "," if self.h_msl_m is None else f"{self.h_msl_m:.3f},M"
        separation = "," if self.separation_m is None else f"{self.separation_m:.3f},M"
        return sentence(f"{talker}GGA,{self._time},{self._place},{self.quality},09,{self.hdop},{height},{separation},,")

    def rmc(self, talker: str = "GN") -> bytes:
        status, mode = (
            ("A", {1: "A", 2: "D", 4: "R", 5: "F", 6: "E"}.get(self.quality, "S")) if self.quality else ("V", "N")
        )
        knots, course = self._motion
        return sentence(f"{talker}RMC,{self._time},{status},{self._place},{knots},{course},{self.date},,,{mode}")

    def vtg(self, talker: str = "GN") -> bytes:
        knots, course = self._motion
        return sentence(f"{talker}VTG,{course},T,,M,{knots},N,{self.speed_m_s * 3.6:.3f},K,A")

    def gst(self, talker: str = "GN", sigma_m: tuple[float, float, float] = (1.5, 2.5, 4.0)) -> bytes:
        """Of standard deviations north, east, up."""
        return sentence(f"{talker}GST,{self._time},9.9,,,,{sigma_m[0]},{sigma_m[1]},{sigma_m[2]}")

    def gll(self, talker: str = "GN") -> bytes:
        return sentence(f"{talker}GLL,{self._place},{self._time},A,A")

    def gsa(self) -> bytes:
        """Of two systems, as NMEA 4.1 has it."""
        return sentence("GNGSA,A,3,05,13,20,,,,,,,,,,1.8,0.9,1.6,1") + sentence("GNGSA,A,3,68,,,,,,,,,,,,1.8,0.9,1.6,2")

    def gsv(self) -> bytes:
        """Of two systems, one of them in two parts."""
        return b"".join(
            (
                sentence("GPGSV,2,1,05,05,45,347,45,13,58,198,44,20,15,123,31,29,03,020,,1"),
                sentence("GPGSV,2,2,05,46,40,150,38,1"),
                sentence("GLGSV,1,1,02,68,55,168,44,83,52,346,,1"),
            )
        )


#: In what order receivers of several makers send what they send (as their logs show), by a name for each.
STYLES = {
    "u-blox": ("rmc", "vtg", "gga", "gsa", "gsv", "gll", "gst"),
    "SiRF": ("gga", "gsa", "gsv", "rmc", "vtg"),
    "modem": ("gsv", "gll", "vtg", "gsa", "gga", "rmc"),
    "RTK": ("gga", "rmc"),
    "no RMC": ("gga", "vtg", "gsa"),
}


def burst(style: str, moment: Moment) -> bytes:
    """Return all that a receiver says of one moment."""
    return b"".join(getattr(moment, kind)() for kind in STYLES[style])


def walk(seconds: int, start_s: float = 43_200.0) -> list[Moment]:
    """Return a walk to the north-east at 1.4 m/s."""
    step_m = 1.4 / 2**0.5
    lat_step, lon_step = degrees(step_m / 6.36e6), degrees(step_m / (6.38e6 * float(np.cos(np.radians(37.9366)))))
    return [
        Moment(start_s + i, 37.9366 + i * lat_step, 27.3447 + i * lon_step, h_msl_m=48.0 + 0.01 * i)
        for i in range(seconds)
    ]


def ubx(moment: Moment, sigma_h_m: float = 1.5, sigma_up_m: float = 2.5) -> bytes:
    """Return a moment in u-blox's binary protocol: NAV-PVT, NAV-DOP and NAV-EOE (u-blox M8 receiver description, UBX-13003221)."""
    itow_ms = round((5 * 86_400 + moment.utc_s + 18.0) * 1000)  # a Friday; GPS time is 18 s ahead
    hours, rest = divmod(round(moment.utc_s), 3600)
    height_mm = round(1000 * ((moment.h_msl_m or 0.0) + (moment.separation_m or 0.0)))
    place = (round(moment.lon_deg * 1e7), round(moment.lat_deg * 1e7), height_mm, round(1000 * (moment.h_msl_m or 0.0)))
    speed_mm_s, heading = round(1000 * moment.speed_m_s), np.radians(moment.heading_deg or 0.0)
    v_ned_mm_s = (round(speed_mm_s * float(np.cos(heading))), round(speed_mm_s * float(np.sin(heading))), 0)
    pvt = struct.pack(
        "<IHBBBBBBIiBBBB4iII3iiiIIH14x",
        *(itow_ms, 2026, 8, 28, hours, rest // 60, rest % 60, 0x37, 20, 0, 3, 1, 0xE0, 9),
        *(*place, round(1000 * sigma_h_m), round(1000 * sigma_up_m), *v_ned_mm_s, speed_mm_s),
        *(round(1e5 * (moment.heading_deg or 0.0)), 100, 100_000, 120),
    )
    dop = struct.pack("<I7H", itow_ms, 200, 180, 90, 160, round(100 * moment.hdop), 70, 60)
    return _ubx_frame(0x07, pvt) + _ubx_frame(0x04, dop) + _ubx_frame(0x61, struct.pack("<I", itow_ms))


def _ubx_frame(message: int, payload: bytes) -> bytes:
    body = bytes((0x01, message)) + struct.pack("<H", len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 0xFF
        b = (b + a) & 0xFF
    return b"\xb5\x62" + body + bytes((a, b))
