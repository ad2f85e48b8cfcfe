"""How far a fix may be off: the receiver's own word where it gives one, else dilution of precision times a range error."""

from dataclasses import dataclass
from math import sqrt

from tracker.sources.nmea_sentence import Gst


@dataclass(frozen=True, slots=True)
class Quality:
    """What GGA's quality indicator means."""

    words: str
    is_position: bool
    """Whether it was measured where the rig is."""
    range_error_m: float
    """One sigma of the ranges to satellites: a position's is this times the dilution of precision."""
    least_sigma_m: float
    """No receiver is believed to be better than this, along each axis, whatever it says."""


#: By GGA's number (NovAtel writes 9 for SBAS). The range errors are what is usual for low-cost receivers in the open: 3.5 m
#: autonomous, 2.5 m along each axis at HDOP 1 (the signal in space is 1 to 2 m of it, the ionosphere and reflections the rest: GPS
#: Standard Positioning Service Performance Standard, 2020, appendix B); 2 m with SBAS or DGPS, which take the ionosphere away;
#: 0.5 m with carrier phases whose integers are not found yet, 2 cm once they are. Estimated positions are dead reckoning by the
#: receiver and drift; manual ones were typed in and simulated ones made up, so neither says where the rig is.
QUALITIES = {
    0: Quality("no fix", False, 0.0, 0.0),
    1: Quality("autonomous", True, 3.5, 0.5),
    2: Quality("differential (DGPS or SBAS)", True, 2.0, 0.3),
    3: Quality("PPS", True, 3.0, 0.3),
    4: Quality("RTK fixed", True, 0.02, 0.005),
    5: Quality("RTK float", True, 0.5, 0.05),
    6: Quality("estimated (dead reckoning)", True, 20.0, 10.0),
    7: Quality("manual input", False, 0.0, 0.0),
    8: Quality("simulated", False, 0.0, 0.0),
    9: Quality("differential (SBAS)", True, 2.0, 0.3),
}

#: Where the receiver states no dilution of precision: a middling sky.
_USUAL_HDOP = 2.0
#: Vertical over horizontal dilution, where only the horizontal one is stated.
_VERTICAL_RATIO = 1.6
#: A position from two dimensions holds the height that was true some time ago.
_HELD_HEIGHT_M = 50.0
#: The geoid lies up to 106 m from the ellipsoid, 30 m rms: heights are this uncertain where the receiver does not know it.
_UNKNOWN_GEOID_M = 30.0
#: Nothing is known of the height.
_UNKNOWN_HEIGHT_M = 1000.0
_MOST_M = 10_000.0


def covariance(
    quality: int,
    *,
    hdop: float | None = None,
    vdop: float | None = None,
    gst: Gst | None = None,
    is_flat: bool = False,
    knows_geoid: bool = True,
    knows_height: bool = True,
) -> tuple[float, ...]:
    """Return the (3, 3) covariance of a fix, row major, east north up, m2.

    Args:
        quality: GGA's quality indicator.
        hdop: Horizontal dilution; one sigma of the horizontal error, both axes together, over the range error.
        vdop: Vertical dilution.
        gst: The receiver's own standard deviations, which count for more.
        is_flat: Whether the height was held, not measured.
        knows_geoid: Whether the height above the ellipsoid is known as well as that above the sea.
        knows_height: Whether there is a height at all.
    """
    kind = QUALITIES[quality]
    hdop = hdop or _USUAL_HDOP  # 0.0 is how some receivers write nothing
    vdop = vdop or hdop * _VERTICAL_RATIO
    each_m = kind.range_error_m * hdop / sqrt(2.0)
    east_m = _stated(gst.sigma_east_m if gst else None, each_m, kind)
    north_m = _stated(gst.sigma_north_m if gst else None, each_m, kind)
    up_m = _stated(gst.sigma_up_m if gst else None, kind.range_error_m * vdop, kind)
    extra_m = (
        _UNKNOWN_HEIGHT_M * (not knows_height),
        _UNKNOWN_GEOID_M * (not knows_geoid),
        _HELD_HEIGHT_M * is_flat,
    )
    up_m2 = up_m**2 + sum(extra**2 for extra in extra_m)
    return (east_m**2, 0.0, 0.0, 0.0, north_m**2, 0.0, 0.0, 0.0, up_m2)


def _stated(sigma_m: float | None, otherwise_m: float, kind: Quality) -> float:
    return min(max(sigma_m or otherwise_m, kind.least_sigma_m), _MOST_M)
