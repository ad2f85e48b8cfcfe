"""Where north is, from motion alone: gains of velocity as the receiver saw them beside those that the inertial sensors felt."""

from collections.abc import Sequence
from itertools import pairwise
from math import sqrt

from tests.benchmarks.accuracy.rivals.nodes import Node
from tests.benchmarks.accuracy.rivals.track import InertialTrack

#: Pairs of nodes within this of a time tell its heading: the level frame turns with the gyroscope's offset.
WINDOW_NS = 60_000_000_000
#: A gain is the receiver's to this, m/s, and counts for no more than the second figure.
GAIN_SIGMA_M_S, LARGEST_GAIN_M_S = 0.2, 2.0


class Alignment:
    """The turn from the level frame to site about a time."""

    def __init__(self, nodes: Sequence[Node], track: InertialTrack) -> None:
        self._t_ns: list[int] = []
        self._products: list[tuple[complex, float]] = []
        """Of each pair of nodes: gain felt (conjugate) times gain seen, and the square of the gain felt."""
        for before, after in pairwise(nodes):
            seen_before, seen_after = _horizontal(before), _horizontal(after)
            if seen_before is None or seen_after is None:
                continue
            felt = track.gained_m_s(before.t_ns, after.t_ns)
            shorten = min(1.0, LARGEST_GAIN_M_S / max(abs(felt), 1e-9))
            self._t_ns.append(after.t_ns)
            self._products.append(
                (shorten**2 * felt.conjugate() * (seen_after - seen_before), (shorten * abs(felt)) ** 2)
            )

    def turn(self, t_ns: int) -> tuple[complex, float]:
        """Return the turn as a unit complex number, and its standard deviation in rad (inf where nothing tells)."""
        near = [product for at, product in zip(self._t_ns, self._products, strict=True) if abs(at - t_ns) < WINDOW_NS]
        total, weight = sum((one[0] for one in near), 0j), sum(one[1] for one in near)
        if abs(total) < 1e-9:
            return 1.0 + 0.0j, float("inf")
        # gains that do not agree leave a sum that is shorter than they are together
        return total / abs(total), GAIN_SIGMA_M_S * sqrt(weight) / abs(total)


def _horizontal(node: Node) -> complex | None:
    return None if node.v_site_m_s is None else complex(node.v_site_m_s[0], node.v_site_m_s[1])
