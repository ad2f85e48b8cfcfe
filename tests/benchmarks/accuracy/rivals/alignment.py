"""Where north is, from motion alone: gains of velocity as the receiver saw them beside those that the inertial sensors felt."""

from collections.abc import Sequence
from itertools import pairwise

from tests.benchmarks.accuracy.rivals.nodes import Node
from tests.benchmarks.accuracy.rivals.track import InertialTrack

#: Pairs of nodes within this of a time tell its heading: the level frame turns with the gyroscope's offset.
WINDOW_NS = 60_000_000_000
#: A gain counts for no more than this, m/s.
LARGEST_GAIN_M_S = 2.0


class Alignment:
    """The turn from the level frame to site about a time."""

    def __init__(self, nodes: Sequence[Node], track: InertialTrack) -> None:
        self._products: list[tuple[int, complex]] = []
        """Of each pair of nodes: when, and the gain felt (conjugate) times the gain seen, which points along the turn."""
        for (before, v_before), (after, v_after) in pairwise(zip(nodes, _velocities(nodes), strict=True)):
            if v_before is None or v_after is None:
                continue
            felt = track.gained_m_s(before.t_ns, after.t_ns)
            shorten = min(1.0, LARGEST_GAIN_M_S / max(abs(felt), 1e-9))
            self._products.append((after.t_ns, shorten**2 * felt.conjugate() * (v_after - v_before)))

    def turn(self, t_ns: int) -> complex:
        """Return the turn as a complex number of that direction; 1 where nothing tells."""
        total = sum((product for at, product in self._products if abs(at - t_ns) < WINDOW_NS), 0j)
        return total if abs(total) > 1e-9 else 1.0 + 0j


def _velocities(nodes: Sequence[Node]) -> list[complex | None]:
    """Return each node's horizontal velocity; from the fixes around it, of a receiver that tells none."""
    told = [None if one.v_site_m_s is None else complex(*one.v_site_m_s[:2]) for one in nodes]
    if any(v is not None for v in told):
        return told
    for index in range(1, len(nodes) - 1):
        before, after = nodes[index - 1], nodes[index + 1]
        if before.fix is not None and after.fix is not None:
            gone_m = complex(*after.fix.p_site_m[:2]) - complex(*before.fix.p_site_m[:2])
            told[index] = gone_m / ((after.t_ns - before.t_ns) * 1e-9)
    return told
