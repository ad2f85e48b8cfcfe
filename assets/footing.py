"""Where one can stand on a monument and where one cannot, in each model: its floors, its stairs and its solids.

Simple on purpose: rectangles and prisms in the monument's own axes, by its kind. Columns do not stop anybody.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import shapely
from shapely import Point, Polygon
from shapely.geometry.base import BaseGeometry

from assets.records import MODEL, PAVING, Epoch, Monument
from assets.shape import footprint_own_m

WALL_M = 0.8
DOOR_M = 2.6
STAGE, ORCHESTRA = 0.25, 0.19
"""Of a theatre, as shares of its radius: depth of the stage building, and radius of the orchestra."""
STAIR_M = 1.2
"""Depth of the stair that leads to a floor from the ground before it."""


@dataclass(frozen=True)
class Floor:
    """A place to stand: level at `z_m`, or rising along y from the ground before it."""

    outline: BaseGeometry
    z_m: float
    """Above the monument's floor level."""
    rises_from: str | None = None
    """The side at which it meets the ground: `south`, `east`, `north`, `west` in own axes; None where it is level."""


@dataclass(frozen=True)
class Solid:
    """A prism that nobody walks through, from the ground to `top_m` above the monument's floor level."""

    outline: BaseGeometry
    top_m: float


@dataclass(frozen=True)
class Footing:
    """All of one monument. Own axes: x from the first corner of its footprint to the second, y to its left."""

    floors: tuple[Floor, ...] = ()
    solids: tuple[Solid, ...] = ()


Rule = Callable[[Monument, Polygon], Footing]
SIDES = ("south", "east", "north", "west")


def footing(monument: Monument, epoch: Epoch) -> Footing:
    """Return where one stands on a monument in a model; a kind without a rule is solid, paving is ground."""
    if monument.kind == PAVING:
        return Footing()
    outline = Polygon(footprint_own_m(monument))
    rule = (ANCIENT if epoch == "roman" else RUINED).get(monument.kind)
    if rule is not None:
        return rule(monument, outline)
    height = monument.height_m
    if epoch == "today" and monument.kind != MODEL:
        height = min(height, LEFT_M.get(monument.kind, height))
    return Footing(solids=(Solid(outline, height),))


def _stairs(monument: Monument, outline: Polygon) -> Footing:
    return Footing(floors=(Floor(outline, monument.height_m, "south"),))


def _stoa(monument: Monument, outline: Polygon) -> Footing:
    """Open at one side, walls at the others."""
    return _hall(monument, outline, SIDES[int(monument.measure("open_side"))], monument.measure("eave_m"))


def _ruined_stoa(monument: Monument, outline: Polygon) -> Footing:
    """As it was; of the walls, what reaches to the knee."""
    return _hall(monument, outline, SIDES[int(monument.measure("open_side"))], 1.0)


def _hall(monument: Monument, outline: Polygon, open_side: str, wall_m: float) -> Footing:
    x0, y0, x1, y1 = outline.bounds
    room = shapely.box(
        x0 + (-WALL_M if open_side == "west" else WALL_M),
        y0 + (-WALL_M if open_side == "south" else WALL_M),
        x1 - (-WALL_M if open_side == "east" else WALL_M),
        y1 - (-WALL_M if open_side == "north" else WALL_M),
    )
    inside = outline.intersection(room)
    stair = _strip(inside, open_side, STAIR_M)
    floors = (Floor(inside.difference(stair), 0.0), Floor(stair, 0.0, open_side))
    return Footing(floors, (Solid(outline.difference(inside), wall_m),))


def _basilica(monument: Monument, outline: Polygon) -> Footing:
    """Steps of their own lead up to it; only its rear is closed."""
    rear = _strip(outline, "north", WALL_M)
    return Footing((Floor(outline.difference(rear), 0.0),), (Solid(rear, monument.measure("aisle_eave_m")),))


def _ruined_basilica(monument: Monument, outline: Polygon) -> Footing:
    rear = _strip(outline, "north", WALL_M)
    return Footing((Floor(outline.difference(rear), 0.0),), (Solid(rear, 1.0),))


def _court(monument: Monument, outline: Polygon) -> Footing:
    """Walled, with a door in the middle of the first side and a podium at the west end."""
    wall, inside, doorway = _walled(outline)
    x0, y0, _, y1 = inside.bounds
    podium = inside.intersection(shapely.box(x0, y0 + 4.5, x0 + 10.2, y1 - 4.5))
    floor = Floor(inside.difference(podium), 0.0)
    solids = (Solid(wall, monument.measure("column_height_m")), Solid(podium, monument.height_m))
    return Footing((floor, Floor(doorway, 0.0, "south")), solids)


def _prytaneion(monument: Monument, outline: Polygon) -> Footing:
    """The forecourt and the porch are open to visitors, what lies behind is not."""
    x0, y0, x1, y1 = outline.bounds
    middle = y0 + min(27.3, 0.55 * (y1 - y0))
    front, behind = (outline.intersection(shapely.box(x0, a, x1, b)) for a, b in ((y0, middle), (middle, y1)))
    wall, inside, doorway = _walled(front)
    solids = (Solid(wall, monument.measure("column_height_m")), Solid(behind, monument.height_m))
    return Footing((Floor(inside, 0.0), Floor(doorway, 0.0, "south")), solids)


def _theatre(monument: Monument, outline: Polygon) -> Footing:
    """The orchestra before the seats, and the way to it through the middle of the front."""
    x0, y0, x1, _ = outline.bounds
    radius, middle = (x1 - x0) / 2.0, (x0 + x1) / 2.0
    front = y0 + STAGE * radius
    orchestra = Point(middle, front).buffer(ORCHESTRA * radius)
    passage = shapely.box(middle - DOOR_M / 2.0, y0 + STAIR_M, middle + DOOR_M / 2.0, front)
    stair = outline.intersection(shapely.box(middle - DOOR_M / 2.0, y0, middle + DOOR_M / 2.0, y0 + STAIR_M))
    inside = orchestra.difference(shapely.box(x0, y0, x1, front)).union(passage)
    solid = outline.difference(inside).difference(stair)
    return Footing((Floor(inside, 0.0), Floor(stair, 0.0, "south")), (Solid(solid, monument.measure("eave_m")),))


def _ruined_court(monument: Monument, outline: Polygon) -> Footing:
    """Wall feet about a floor of earth, open where the door was."""
    wall, inside, doorway = _walled(outline)
    return Footing((Floor(inside, 0.0), Floor(doorway, 0.0, "south")), (Solid(wall, 1.0),))


def _temple(monument: Monument, outline: Polygon) -> Footing:
    """The colonnade around the closed cella; its steps stand before the footprint, and are climbed all along the east."""
    x0, y0, x1, y1 = outline.bounds
    bay_x = (x1 - x0) / monument.measure("columns_long")
    bay_y = (y1 - y0) / monument.measure("columns_short")
    cella = shapely.box(x0 + 1.3 * bay_x, y0 + 1.3 * bay_y, x1 - 1.8 * bay_x, y1 - 1.3 * bay_y)
    stair = _strip(outline, "east", STAIR_M)
    floor = outline.difference(cella).difference(stair)
    return Footing((Floor(floor, 0.0), Floor(stair, 0.0, "east")), (Solid(cella, monument.measure("column_height_m")),))


def _terrace(monument: Monument, outline: Polygon) -> Footing:
    """Its top is a place to stand, which no way leads to here."""
    return Footing((Floor(outline, monument.height_m),), (Solid(outline, monument.height_m),))


def _gate(monument: Monument, outline: Polygon) -> Footing:
    """A passage from the first side to the third, between two walls."""
    walls = _strip(outline, "east", WALL_M).union(_strip(outline, "west", WALL_M))
    return Footing((Floor(outline.difference(walls), 0.0),), (Solid(walls, monument.measure("column_height_m")),))


def _walled(outline: BaseGeometry) -> tuple[BaseGeometry, BaseGeometry, BaseGeometry]:
    """Wall, floor and doorway of a place with a wall all around."""
    inside = outline.buffer(-WALL_M, join_style="mitre")
    x0, y0, x1, _ = outline.bounds
    middle = (x0 + x1) / 2.0
    wall = outline.difference(inside)
    gap = shapely.box(middle - DOOR_M / 2.0, y0 - WALL_M, middle + DOOR_M / 2.0, y0 + 2.0 * WALL_M)
    return wall.difference(gap), inside, wall.intersection(gap)


def _strip(outline: BaseGeometry, side: str, depth_m: float) -> BaseGeometry:
    """The part of an outline that lies within `depth_m` of a side of its bounds."""
    x0, y0, x1, y1 = outline.bounds
    box = {
        "south": (x0, y0, x1, y0 + depth_m),
        "east": (x1 - depth_m, y0, x1, y1),
        "north": (x0, y1 - depth_m, x1, y1),
        "west": (x0, y0, x0 + depth_m, y1),
    }[side]
    return outline.intersection(shapely.box(*box))


ANCIENT: Mapping[str, Rule] = {
    "basilica": _basilica,
    "bouleuterion": _theatre,
    "court": _court,
    "gate": _gate,
    "prytaneion": _prytaneion,
    "steps": _stairs,
    "stoa": _stoa,
    "temple": _temple,
    "terrace": _terrace,
}
RUINED: Mapping[str, Rule] = {
    "basilica": _ruined_basilica,
    "bouleuterion": _theatre,
    "court": _ruined_court,
    "prytaneion": _ruined_court,
    "steps": _stairs,
    "stoa": _ruined_stoa,
    "terrace": _terrace,
}
LEFT_M: Mapping[str, float] = {
    "altar": 1.0,
    "basin": 1.0,
    "baths": 6.0,
    "chambers": 4.0,
    "gate": 1.0,
    "hall": 1.0,
    "nymphaeum": 3.0,
    "temple": 0.5,
    "tower": 7.0,
}
"""How high a kind still stands today, where that is less than it was; the data sheet's words in metres."""
