"""What a magnetometer or a phone's compass is good for: a first guess at north, where the field is the Earth's."""

from math import atan2, cos, hypot, pi, sin

from tracker.geometry import rotate, wrap_rad, yaw_of
from tracker.measurements import MagSample, Wxyz

#: A field whose strength or dip differs by more than this from the model's has iron in it.
STRENGTH_SHARE = 0.15
DIP_RAD = 0.12
MEMORY = 0.05


class Compass:
    """The turn from the filter's present heading to what the field says, averaged."""

    def __init__(self, declination_rad: float, field_t: float = 0.0, dip_rad: float = 0.0) -> None:
        """Declination (east), strength and dip (downward) of the Earth's field here; strength 0 where it is not known."""
        self._field_t, self._dip_rad, self._declination_rad = field_t, dip_rad, declination_rad
        self._cos = self._sin = 0.0
        self._seen = 0
        self.is_trusted = False
        """Whether the last sample was the Earth's field."""

    def field(self, sample: MagSample, wxyz_site_body: Wxyz) -> None:
        """Take a sample, and the attitude at its stamp."""
        x, y, z = rotate(wxyz_site_body, sample.field_body_t)
        flat = hypot(x, y)
        if flat == 0.0:
            return
        strength, dip = hypot(flat, z), atan2(-z, flat)
        self.is_trusted = self._field_t == 0.0 or (
            abs(strength / self._field_t - 1.0) < STRENGTH_SHARE and abs(dip - self._dip_rad) < DIP_RAD
        )
        self.heading(pi / 2 - self._declination_rad - atan2(y, x))

    def heading(self, off_rad: float) -> None:
        """Take a turn that the heading wants."""
        self._seen += 1
        share = max(MEMORY, 1.0 / self._seen)
        self._cos += share * (cos(off_rad) - self._cos)
        self._sin += share * (sin(off_rad) - self._sin)

    def yaw_rad(self, wxyz_site_body: Wxyz) -> float | None:
        """Return the heading of body x; None where nothing was told."""
        if self._seen == 0:
            return None
        return wrap_rad(yaw_of(wxyz_site_body) + atan2(self._sin, self._cos))
