"""Where a simulated visitor goes, stops and looks: a draft in knots of a tenth of a second. How a body moves is `gait`'s matter."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import atan2, hypot, pi, radians

import numpy as np

from tracker.measurements import Matrix, Vector3

KNOT_S = 0.1


@dataclass(frozen=True)
class Tour:
    """The walkable place: a ring of way-points, a convex loop in the open, and what is worth looking at. Site frame, metres."""

    ring_en_m: tuple[tuple[float, float], ...]
    """Closed; straight legs between neighbours keep 5 m from anything built."""
    loop_en_m: tuple[tuple[float, float], ...]
    """Closed and convex with nothing inside, so that it may be shrunk to fit a short walk."""
    sights_m: tuple[Vector3, ...]
    """Points at the height where a visitor looks at them."""


#: Around the open square of the State Agora, past its temple on all sides, and the centres of the monuments about it.
#: After OpenStreetMap footprints, (c) OpenStreetMap contributors, ODbL 1.0.
AGORA_TOUR = Tour(
    ring_en_m=(
        (-2.6, -9.7),
        (-21.9, -4.5),
        (-46.8, -0.9),
        (-74.8, 6.6),
        (-93.1, 0.1),
        (-93.0, -18.6),
        (-67.4, -27.5),
        (-40.9, -36.7),
        (-11.4, -42.5),
        (18.6, -46.4),
        (29.6, -28.6),
        (17.0, -13.9),
    ),
    loop_en_m=((27.0, -42.5), (36.5, -17.4), (-29.0, 0.2), (-37.0, -26.0)),
    sights_m=(
        (17.9, 27.0, 7.0),  # Bouleuterion
        (-22.8, 15.0, 5.0),  # Basilica Stoa
        (-70.0, 29.0, 5.0),  # its west end
        (-42.3, 55.0, 7.0),  # Prytaneion
        (-63.2, -11.9, 5.0),  # temple in the square
        (-109.6, 14.0, 4.0),  # Pollio monument and Fountain of Domitian
        (-43.1, -50.0, 4.0),  # South Stoa
        (45.0, -39.1, 4.0),  # east stoa
    ),
)


@dataclass(frozen=True)
class Pattern:
    """A kind of walk, as one of the paper's five datasets was. Shares are per act of a visit."""

    stop_share: float = 0.45
    look_round_share: float = 0.35
    """Of the stops."""
    glance_share: float = 0.7
    """Of the stretches."""
    walks: bool = True
    closes_loop: bool = False
    sways: bool = True


#: 0 is an ordinary visit; the others are in the manner of the paper's datasets, of which it prints sizes and draws paths.
PATTERNS = {
    0: Pattern(),
    1: Pattern(),
    2: Pattern(stop_share=0.25),
    3: Pattern(walks=False, sways=False),
    4: Pattern(stop_share=0.6, glance_share=0.9),
    5: Pattern(closes_loop=True),
}

#: The printed sizes of the paper's datasets (its two tables of errors), in filter updates.
DATASET_UPDATES = {1: 3388, 2: 1735, 3: 182, 4: 1406, 5: 3515}
#: Four updates a second, and time for the first fix to arrive: the filter starts with it, 0.12 to 0.32 s into the walk.
DATASET_DURATION_S = {dataset: updates / 4.0 + 0.35 for dataset, updates in DATASET_UPDATES.items()}


@dataclass(frozen=True, eq=False)
class Draft:
    """Where to be and look at each knot, angular and jerky still; every array (m,). Angles do not wrap."""

    e_m: Matrix
    n_m: Matrix
    yaw_rad: Matrix
    course_rad: Matrix
    nose_up_rad: Matrix


class Route:
    """A closed polyline by its arc length."""

    def __init__(self, corners_en_m: Matrix) -> None:
        self._corners_m = np.vstack([corners_en_m, corners_en_m[:1]])
        self._legs_m = np.diff(self._corners_m, axis=0)
        self._reached_m = np.concatenate([[0.0], np.cumsum(np.hypot(self._legs_m[:, 0], self._legs_m[:, 1]))])
        self.length_m = float(self._reached_m[-1])

    def at(self, travelled_m: float) -> tuple[float, float, float]:
        """Return east, north and course (radians, counter-clockwise from east)."""
        along_m = travelled_m % self.length_m
        leg = min(int(np.searchsorted(self._reached_m, along_m, side="right")) - 1, len(self._legs_m) - 1)
        de, dn = self._legs_m[leg]
        fraction = (along_m - self._reached_m[leg]) / hypot(de, dn)
        e, n = self._corners_m[leg] + fraction * self._legs_m[leg]
        return float(e), float(n), atan2(dn, de)


def nearest_turn_rad(angle_rad: float, to_rad: float) -> float:
    """Return the angle plus whole turns, at most half a turn from `to_rad`."""
    return angle_rad + 2.0 * pi * round((to_rad - angle_rad) / (2.0 * pi))


class _Script:
    """Writes a draft, act after act."""

    def __init__(self, route: Route, sights_m: tuple[Vector3, ...], eye_height_m: float, rng: np.random.Generator):
        self.route = route
        self._sights_m = sights_m
        self._eye_height_m = eye_height_m
        self._rng = rng
        self._travelled_m = 0.0
        self._e_m, self._n_m, self._course_rad = route.at(0.0)
        self.yaw_rad = self._course_rad
        self._rows: list[tuple[float, float, float, float, float]] = []

    @property
    def written_s(self) -> float:
        return len(self._rows) * KNOT_S

    def write(self, yaw_rad: float, nose_up_rad: float) -> None:
        """Add one knot here with this view."""
        self.yaw_rad = nearest_turn_rad(yaw_rad, self.yaw_rad)
        self._rows.append((self._e_m, self._n_m, self.yaw_rad, self._course_rad, nose_up_rad))

    def view(self, widest_rad: float) -> tuple[float, float]:
        """Return yaw and nose-up angle of a sight near by, or of a random direction where none is within reach."""
        views, weights = [], []
        for e, n, z in self._sights_m:
            distance_m = hypot(e - self._e_m, n - self._n_m)
            yaw_rad = nearest_turn_rad(atan2(n - self._n_m, e - self._e_m), self._course_rad)
            if abs(yaw_rad - self._course_rad) <= widest_rad and 6.0 < distance_m < 80.0:
                rise_rad = atan2(z - self._eye_height_m, distance_m)
                views.append((yaw_rad, min(rise_rad, radians(20.0))))
                weights.append(1.0 / distance_m)
        if not views:
            return self._course_rad + self._rng.choice([-1.0, 1.0]) * radians(self._rng.uniform(20.0, 50.0)), 0.0
        return views[int(self._rng.choice(len(views), p=np.array(weights) / sum(weights)))]

    def stand(self, duration_s: float, yaw_rad: float, nose_up_rad: float) -> None:
        """Stand and look there."""
        for _ in range(round(duration_s / KNOT_S)):
            self.write(yaw_rad, nose_up_rad)

    def look_round(self) -> None:
        """Turn once on the spot, at about 40 degrees a second."""
        side = float(self._rng.choice([-1.0, 1.0]))
        knots = round(self._rng.uniform(8.5, 10.0) / KNOT_S)
        start_rad = self.yaw_rad
        for k in range(1, knots + 1):
            self.write(start_rad + side * 2.0 * pi * k / knots, radians(1.0))

    def nod(self) -> None:
        """Look down at the paving (or at a guide book) and up again."""
        self.stand(self._rng.uniform(0.8, 1.4), self.yaw_rad, radians(self._rng.uniform(-20.0, -10.0)))

    def advance(self, distance_m: float, speed_m_s: float, glances: bool) -> None:
        """Walk on along the route, looking ahead and a little down, and once to the side if it glances."""
        knots = max(1, round(distance_m / speed_m_s / KNOT_S))
        first = round(knots * self._rng.uniform(0.2, 0.4))
        last = first + round(self._rng.uniform(1.5, 2.5) / KNOT_S) if glances else first
        offset_rad, rise_rad = 0.0, 0.0
        for k in range(knots):
            self._travelled_m += distance_m / knots
            self._e_m, self._n_m, course_rad = self.route.at(self._travelled_m)
            self._course_rad = nearest_turn_rad(course_rad, self._course_rad)
            if k == first and glances:
                yaw_rad, rise_rad = self.view(widest_rad=radians(65.0))
                offset_rad = yaw_rad - self._course_rad
            if first <= k < last:
                self.write(self._course_rad + offset_rad, rise_rad)
            else:
                self.write(self._course_rad, radians(-4.0))

    def draft(self) -> Draft:
        """Return what has been written."""
        e, n, yaw, course, nose_up = np.array(self._rows).T
        return Draft(e, n, yaw, course, nose_up)


def choreograph(
    pattern: Pattern, tour: Tour, duration_s: float, still_s: float, eye_height_m: float, rng: np.random.Generator
) -> Draft:
    """Return a draft of at least `duration_s`, standing with an unmoved view for the first 70 % of `still_s`.

    Args:
        pattern: What kind of walk.
        tour: Where.
        duration_s: How long.
        still_s: How long the visitor stands before the first step.
        eye_height_m: The rig above the ground.
        rng: Decides start, direction, speeds, stops and views.
    """
    if pattern.closes_loop:
        script = _close_loop(tour, duration_s, still_s, eye_height_m, rng)
    else:
        corners_m = np.array(tour.ring_en_m) + rng.uniform(-1.5, 1.5, (len(tour.ring_en_m), 2))
        corners_m = np.roll(corners_m, int(rng.integers(len(corners_m))), axis=0)
        if rng.random() < 0.5:
            corners_m = corners_m[::-1]
        script = _Script(Route(corners_m), tour.sights_m, eye_height_m, rng)
        _open_scene(script, pattern, still_s)
        acts = _acts(rng)
        while script.written_s < duration_s:
            if pattern.walks:
                _visit(script, pattern, next(acts), rng)
            else:
                script.stand(1.0, script.yaw_rad, 0.0)
    return script.draft()


def _open_scene(script: _Script, pattern: Pattern, still_s: float) -> None:
    """Stand: for the first 70 % without any movement, as a rig's calibration at rest asks for, then look about a little."""
    script.stand(0.7 * still_s, script.yaw_rad, 0.0)
    yaw_rad, rise_rad = script.view(widest_rad=radians(60.0)) if pattern.walks else (script.yaw_rad, 0.0)
    script.stand(0.3 * still_s, yaw_rad, rise_rad)


def _acts(rng: np.random.Generator) -> Iterator[float]:
    """Yield the speeds of the stretches, m/s: strolling, normal and brisk in random order, each once in three."""
    while True:
        yield from rng.permutation([rng.uniform(0.6, 0.8), rng.uniform(0.95, 1.2), rng.uniform(1.4, 1.6)]).tolist()


def _visit(script: _Script, pattern: Pattern, speed_m_s: float, rng: np.random.Generator) -> None:
    """Walk a stretch, and perhaps stop at its end to look at something, once round, or down."""
    script.advance(rng.uniform(5.0, 12.0), speed_m_s, glances=bool(rng.random() < pattern.glance_share))
    if rng.random() >= pattern.stop_share:
        return
    yaw_rad, rise_rad = script.view(widest_rad=radians(110.0))
    script.stand(rng.uniform(2.0, 5.0), yaw_rad, rise_rad)
    if rng.random() < pattern.look_round_share:
        script.look_round()
    elif rng.random() < 0.5:
        script.nod()


def _close_loop(
    tour: Tour, duration_s: float, still_s: float, eye_height_m: float, rng: np.random.Generator
) -> _Script:
    """Walk once round the loop, shrunk so that it closes in time, and stand where the walk began."""
    corners_m = np.array(tour.loop_en_m)
    centre_m = corners_m.mean(axis=0)
    walking_s = max(10.0, duration_s - still_s - 5.0)
    share = min(1.0, walking_s * 1.1 / Route(corners_m).length_m)
    route = Route(centre_m + share * (corners_m - centre_m))
    script = _Script(route, tour.sights_m, eye_height_m, rng)
    _open_scene(script, Pattern(), still_s)
    laps = max(1, round(walking_s * 1.1 / route.length_m))
    stretches = 8 * laps
    for _ in range(stretches):
        script.advance(
            route.length_m * laps / stretches, route.length_m * laps / walking_s, glances=bool(rng.random() < 0.5)
        )
    script.stand(max(0.0, duration_s - script.written_s) + 1.0, script.yaw_rad, 0.0)
    return script
