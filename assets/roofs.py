"""Tiled roofs on timber: gables, lean-tos, hips. Each adds itself to a shape; x runs along the eaves."""

import numpy as np

from assets.axes import Array
from assets.shape import Shape

SLOPE = float(np.tan(np.radians(17.5)))
EAVE_M = 0.5
"""How far a roof stands out."""
COVER_M = (0.8, 0.0, 0.0)
"""By level: distance of cover tiles that are drawn in relief; 0 leaves them to the texture. A multiple of the texture's own."""
COVER_HALF_M, COVER_HIGH_M = 0.11, 0.09
RAFTER_M = 2.4


def plane(shape: Shape, x0: float, x1: float, low: tuple[float, float], high: tuple[float, float], level: int) -> None:
    """Add a tiled plane from `low` (y, z) up to `high`, with cover tiles, and its boarding below."""
    (ya, za), (yb, zb) = low, high
    rise = float(np.hypot(yb - ya, zb - za))
    if ya > yb:
        turned = Shape()
        plane(turned, -x1, -x0, (-ya, za), (-yb, zb), level)
        shape.copies(turned, np.zeros((1, 3)), np.array([np.pi]))
        return
    count = max(1, round((x1 - x0) / 16.0)) if level == 0 else 1
    x = np.linspace(x0, x1, count + 1)
    a, b, o = x[:-1], x[1:], np.zeros(count)
    corners = _quads((a, o + ya, o + za), (b, o + ya, o + za), (b, o + yb, o + zb), (a, o + yb, o + zb))
    uvs = np.stack([np.stack(c, -1) for c in ((a, o + rise), (b, o + rise), (b, o), (a, o))], axis=1)
    tone = 0.93 + 0.07 * np.sin(7.3 * np.arange(count))[:, None] * np.ones(3)
    shape.panels("tiles", corners, uvs, tone)
    shape.polygons("wood", (corners - (0.0, 0.0, 0.13))[:, ::-1], 0.62)
    if COVER_M[level]:
        _covers(shape, x0, x1, low, high, COVER_M[level])


def _covers(
    shape: Shape, x0: float, x1: float, low: tuple[float, float], high: tuple[float, float], spacing_m: float
) -> None:
    """Add ridges of cover tiles up the slope, each closed at the eave by its antefix."""
    (ya, za), (yb, zb) = low, high
    rise = float(np.hypot(yb - ya, zb - za))
    up = np.array([0.0, -(zb - za), yb - ya]) / rise * COVER_HIGH_M
    x = np.arange(np.ceil(x0 / spacing_m), np.floor(x1 / spacing_m) + 0.5) * spacing_m
    o = np.zeros_like(x)
    foot, head = (o + ya, o + za), (o + yb, o + zb)
    top = (o + ya + up[1], o + za + up[2]), (o + yb + up[1], o + zb + up[2])
    left, right = x - COVER_HALF_M, x + COVER_HALF_M
    sides = np.concatenate(
        [
            _quads((left, *foot), (x, *top[0]), (x, *top[1]), (left, *head)),
            _quads((x, *top[0]), (right, *foot), (right, *head), (x, *top[1])),
        ]
    )
    along = np.array([[[0.0, rise], [0.1, rise], [0.1, 0.0], [0.0, 0.0]]])
    shape.panels("tiles", sides, np.repeat(along, len(sides), axis=0), 1.0)
    ends = np.stack([np.stack(c, -1) for c in ((left, *foot), (right, *foot), (x, o + ya, o + za + 0.3))], axis=1)
    shape.polygons("tiles", ends, 0.9)


def ridge(shape: Shape, x0: float, x1: float, y_m: float, z_m: float, level: int) -> None:
    """Add the ridge's tiles; their top is at `z_m`."""
    if level == 2:
        return
    y, z = np.array([-0.2, -0.1, 0.1, 0.2]) + y_m, np.array([-0.15, 0.0, 0.0, -0.15]) + z_m
    for i in range(3):
        quad = [(x0, y[i], z[i]), (x1, y[i], z[i]), (x1, y[i + 1], z[i + 1]), (x0, y[i + 1], z[i + 1])]
        shape.polygons("tiles", quad, 0.92)


def gable(
    roof: Shape,
    ends: Shape,
    faces: tuple[float, float, float, float],
    eave_m: float,
    ridge_m: float,
    level: int,
    wall: str = "marble",
    out_m: float = EAVE_M,
) -> None:
    """Add a roof with its ridge along x over `faces` (x0, x1, y0, y1), to `ends` its two gables with their rims."""
    x0, x1, y0, y1 = faces
    middle = (y0 + y1) / 2.0
    top = ridge_m - (0.0 if level == 2 else 0.04)
    low = eave_m - out_m * (top - eave_m) / (middle - y0)
    a, b = x0 - out_m, x1 + out_m
    plane(roof, a, b, (y0 - out_m, low), (middle, top), level)
    plane(roof, a, b, (y1 + out_m, low), (middle, top), level)
    ridge(roof, a, b, middle, ridge_m, level)
    triangles = [
        [(x1, y0, eave_m), (x1, y1, eave_m), (x1, middle, top)],
        [(x0, y1, eave_m), (x0, y0, eave_m), (x0, middle, top)],
    ]
    ends.polygons(wall, np.array(triangles), 0.92)
    inside = np.array(triangles)[:, ::-1] + np.array([(-0.2, 0.0, 0.0), (0.2, 0.0, 0.0)])[:, None]
    ends.polygons(wall, inside, 0.8)
    for x, back in ((a, x0), (b, x1)):
        for y, sign in ((y0 - out_m, 1.0), (y1 + out_m, -1.0)):
            _rim(ends, (x, back), (y, low), (middle, top), sign)


def _rim(
    shape: Shape, x: tuple[float, float], low: tuple[float, float], high: tuple[float, float], sign: float
) -> None:
    """Add the raking cornice of half a gable: front, underside, a little sima."""
    (front, back), (ya, za), (yb, zb) = x, low, high
    inward = np.sign(back - front)
    drop, sima = 0.34, 0.05
    face = np.array([(front, ya, za - drop), (front, yb, zb - drop), (front, yb, zb + sima), (front, ya, za + sima)])
    under = np.array([(front, ya, za - drop), (back, ya, za - drop), (back, yb, zb - drop), (front, yb, zb - drop)])
    turn = 1 if inward * sign < 0 else -1
    shape.polygons("marble", face[::turn])
    shape.polygons("marble", under[::turn], 0.85)
    x_front = front - inward * sima
    step = np.array(
        [(x_front, y, z) for y, z in ((ya, za - drop), (yb, zb - drop), (yb, zb - 0.6 * drop), (ya, za - 0.6 * drop))]
    )
    shape.polygons("marble", step[::turn], 0.94)


def lean_to(
    roof: Shape, ends: Shape, x: tuple[float, float], low: tuple[float, float], high: tuple[float, float], level: int,
    wall: str = "plaster",
) -> None:  # fmt: skip
    """Add a roof from `low` (y, z) up to `high` over all of `x`, to `ends` what closes its two sides."""
    plane(roof, *x, low, high, level)
    (ya, za), (yb, zb) = low, high
    for at, end in zip(x, (-1, 1), strict=True):
        side = np.array([(at, ya, za - 0.3), (at, yb, za - 0.3), (at, yb, zb - 0.06), (at, ya, za - 0.06)])
        ends.polygons(wall, side[:: end if ya < yb else -end], 0.9)


def rafters(shape: Shape, x: tuple[float, float], y: tuple[float, float], z_m: float, level: int) -> None:
    """Add the beams of a timber ceiling: across from wall to wall, undersides at `z_m`."""
    if level:
        return
    at = np.arange(x[0] + 0.6, x[1] - 0.3, RAFTER_M)
    o = np.ones_like(at)
    low = np.stack([at - 0.12, o * min(y), o * z_m], -1)
    high = np.stack([at + 0.12, o * max(y), o * (z_m + 0.3)], -1)
    shape.boxes("wood", low, high, 0.8)
    under = _quads(
        *(((at + s * 0.12), o * yy, o * z_m) for s, yy in ((-1, max(y)), (1, max(y)), (1, min(y)), (-1, min(y))))
    )
    shape.polygons("wood", under, 0.7)


def hip(shape: Shape, outline: Array, tops: Array, eave_m: float, ridge_m: float) -> None:
    """Add a tiled roof from an outline (n, 2) up to a point of the ridge for each of its corners, (n, 2), with its underside."""
    low = np.column_stack([outline, np.full(len(outline), eave_m)])
    high = np.column_stack([tops, np.full(len(tops), ridge_m)])
    next_low, next_high = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    corners = np.stack([low, next_low, next_high, high], axis=1)
    run = np.linalg.norm(next_low - low, axis=1)
    level_run = np.linalg.norm(next_high - high, axis=1)
    rise = np.linalg.norm((next_high + high - next_low - low) / 2.0, axis=1)
    side, o = (run - level_run) / 2.0, np.zeros(len(low))
    uvs = np.stack([np.stack(c, -1) for c in ((o, rise), (run, rise), (run - side, o), (side, o))], axis=1)
    shape.panels("tiles", corners, uvs)
    shape.polygons("wood", low[::-1], 0.6)


def _quads(*corners: tuple[Array, Array, Array]) -> Array:
    return np.stack([np.stack(corner, -1) for corner in corners], axis=1)
