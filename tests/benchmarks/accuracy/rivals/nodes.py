"""Where the graph has nodes: at the receiver's stamps, once a second where it is silent; and what it said there."""

from bisect import insort
from dataclasses import dataclass
from math import isfinite

from tests.benchmarks.accuracy.rivals.track import InertialTrack
from tracker.estimator import Origin
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Matrix, Measurement, Vector3
from tracker.precise.claims import Claims, claimed_m
from tracker.precise.settings import PreciseSettings

#: Nodes are at least so far apart: a receiver of 18 Hz says little more than one of 2 Hz, its errors being the same.
CLOSEST_NS = 450_000_000
#: Where the receiver is silent nodes are so far apart, and it counts as silent after the second figure.
SILENT_NS, PATIENCE_NS = 1_000_000_000, 1_600_000_000
#: The first node is so long after the first inertial sample, and a stamp waits for so much inertial time before it is a node.
START_NS, GRACE_NS = 500_000_000, 10_000_000


@dataclass(frozen=True)
class Fix:
    """A position of the antenna."""

    p_site_m: Vector3
    sigma_m: Vector3
    """What its receiver usually claims, as the graph takes it: the error that lasts is in units of it."""
    noisier_m2: Matrix
    """(3,) variances by which it is noisier than usual."""


@dataclass
class Node:
    """A moment whose state is sought."""

    t_ns: int
    fix: Fix | None = None
    sigma_m: Vector3 | None = None
    """Of the last fix until then; None before the first."""
    v_site_m_s: Vector3 | None = None
    """Of the antenna."""


class Nodes:
    """Takes measurements one after another and tells which nodes have become complete."""

    def __init__(self, settings: PreciseSettings, origin: Origin) -> None:
        self._settings, self._site = settings, SiteFrame(origin)
        self.track = InertialTrack(gravity_m_s2(origin.lat_deg, origin.h_ellipsoid_m))
        self._waiting: list[tuple[int, int, GpsFix | GpsVelocity]] = []
        """Stamp, the newest inertial stamp when it came, and what came; ordered by stamp."""
        self._last_ns: int | None = None
        self._claims = Claims()
        self._sigma_m: Vector3 | None = None

    def add(self, measurement: Measurement) -> list[Node]:
        """Take a measurement; return the nodes that are complete with it, oldest first."""
        newest_ns = self.track.newest_ns
        if isinstance(measurement, GpsFix | GpsVelocity):
            if newest_ns is not None and _is_good(measurement):
                insort(self._waiting, (measurement.t_ns, newest_ns, measurement), key=lambda one: one[0])
            return []
        if isinstance(measurement, ImuSample) and self.track.add(measurement):
            return self._complete(measurement.t_ns)
        return []

    def _complete(self, newest_ns: int) -> list[Node]:
        found: list[Node] = []
        if self._last_ns is None:
            if newest_ns < self.track.first_ns + START_NS:
                return []
            found.append(self._at(self.track.first_ns + START_NS))
        assert self._last_ns is not None
        while self._waiting and newest_ns - max(self._waiting[0][:2]) >= GRACE_NS:
            t_ns = self._waiting[0][0]
            while t_ns - self._last_ns >= PATIENCE_NS:
                found.append(self._at(self._last_ns + SILENT_NS))
            if t_ns - self._last_ns >= CLOSEST_NS:
                found.append(self._at(t_ns))
            else:
                del self._waiting[0]
        while not self._waiting and newest_ns - self._last_ns >= PATIENCE_NS:
            found.append(self._at(self._last_ns + SILENT_NS))
        return found

    def _at(self, t_ns: int) -> Node:
        """Return the node at a time, with what waits for it."""
        node, self._last_ns = Node(t_ns), t_ns
        while self._waiting and self._waiting[0][0] <= t_ns:
            stamp, _, measurement = self._waiting.pop(0)
            if stamp < t_ns:
                continue
            if isinstance(measurement, GpsVelocity):
                node.v_site_m_s = measurement.v_enu_m_s
            else:
                node.fix = self._fix(measurement)
                self._sigma_m = node.fix.sigma_m
        node.sigma_m = self._sigma_m
        return node

    def _fix(self, fix: GpsFix) -> Fix:
        usual, noisier_m2 = self._claims.take(claimed_m(fix, self._settings))
        return Fix(self._site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m), usual, noisier_m2)


def _is_good(measurement: GpsFix | GpsVelocity) -> bool:
    if isinstance(measurement, GpsVelocity):
        return isfinite(sum(measurement.v_enu_m_s))
    return measurement.valid and isfinite(measurement.lat_deg + measurement.lon_deg + measurement.h_ellipsoid_m)
