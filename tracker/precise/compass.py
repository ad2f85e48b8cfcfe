"""What a magnetometer or a phone's compass is good for: a first guess at north, where the field is the Earth's."""

from math import atan2, cos, hypot, pi, sin

from tracker.geomagnetism import MagneticField
from tracker.geometry import rotate, wrap_rad, yaw_of
from tracker.measurements import MagSample, Wxyz

#: A field whose strength or dip differs by more than this from the model's has iron in it.
STRENGTH_SHARE = 0.15
DIP_RAD = 0.12
MEMORY = 0.05


class Compass:
    """The turn from the filter's present heading to what the field says, averaged."""

    def __init__(self, declination_rad: float, earth_field: MagneticField | None = None) -> None:
        """`declination_rad` is used whatever the field; without `earth_field` every field is taken for the Earth's."""
        self.declination_rad, self._earth = declination_rad, earth_field
        self._cos = self._sin = 0.0
        self._seen = 0
        self.is_trusted = False
        """Whether the last sample was the Earth's field."""

    def turned(self, by_rad: float) -> None:
        """Take a turn of the filter's heading that the rig has not made: a correction, or another filter that is the best now."""
        c, s = cos(by_rad), sin(by_rad)
        self._cos, self._sin = self._cos * c + self._sin * s, self._sin * c - self._cos * s

    def forget(self) -> None:
        """Forget all that was told: the attitude that it was told for is not known any more."""
        self._cos = self._sin = 0.0
        self._seen = 0

    def field(self, sample: MagSample, wxyz_site_body: Wxyz) -> None:
        """Take a sample, and the attitude at its stamp."""
        x, y, z = rotate(wxyz_site_body, sample.field_body_t)
        flat = hypot(x, y)
        if flat == 0.0:
            self.is_trusted = False  # straight up or down, it points nowhere
            return
        strength, dip = hypot(flat, z), atan2(-z, flat)
        earth = self._earth
        self.is_trusted = earth is None or (
            abs(strength / earth.strength_t - 1.0) < STRENGTH_SHARE and abs(dip - earth.inclination_rad) < DIP_RAD
        )
        self.heading(pi / 2 - self.declination_rad - atan2(y, x))

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
