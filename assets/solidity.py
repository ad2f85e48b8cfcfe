"""Where a monument is solid: what a depth-only stand-in of it may fill.

Meshes here have no faces where nobody looks, so a place counts as solid where a visitor on any of four sides would see a
face before it, or where it is enclosed as in a closed body.
"""

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array

Bools = NDArray[np.bool_]


def solid_cells(triangles: Array, x_m: Array, y_m: Array, z_m: float) -> Bools:
    """Return which points (x, y) of a grid at one height the triangles hide from all four sides.

    On the way out to a side a ray leaves bodies more often than it enters them, or the first face that it meets is one that
    it leaves by.

    Args:
        triangles: (m, 3, 3), counter-clockwise from outside, in any upright axes.
        x_m: (a,) evenly spaced, at least two.
        y_m: (b,) likewise.
        z_m: The height.

    Returns:
        (a, b)
    """
    ends, outward = section(triangles, z_m)
    along_x = _hidden_along(ends, outward, x_m, y_m)
    along_y = _hidden_along(ends[..., ::-1], outward[:, ::-1], y_m, x_m)
    return along_x & along_y.T


def section(triangles: Array, z_m: float) -> tuple[Array, Array]:
    """Return where triangles meet a level plane: segments (k, 2, 2), and the direction (k, 2) that each one's face looks to."""
    above = triangles[:, :, 2] > z_m
    cut = triangles[above.any(axis=1) & ~above.all(axis=1)]
    over = cut[:, :, 2] > z_m
    alone = np.where(over.sum(axis=1) == 1, over.argmax(axis=1), (~over).argmax(axis=1))
    k = np.arange(len(cut))
    tip, others = cut[k, alone], [cut[k, (alone + step) % 3] for step in (1, 2)]
    ends = [tip + ((z_m - tip[:, 2]) / (other[:, 2] - tip[:, 2]))[:, None] * (other - tip) for other in others]
    normal = np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0])
    return np.stack([end[:, :2] for end in ends], axis=1), normal[:, :2]


def _hidden_along(ends: Array, outward: Array, along_m: Array, across_m: Array) -> Bools:
    """Which points (a, b) are hidden from both ends of the lines along the first axis."""
    line, at, sign = _crossings(ends, outward, across_m)
    step = along_m[1] - along_m[0]
    gap = np.clip(np.ceil((at - along_m[0]) / step), 0, len(along_m)).astype(int)
    # gap g lies between points g - 1 and g
    balance, first, last = (np.zeros((len(along_m) + 1, len(across_m))) for _ in range(3))
    np.add.at(balance, (gap, line), sign)
    order = np.argsort(at, kind="stable")
    last[gap[order], line[order]] = sign[order]
    first[gap[order[::-1]], line[order[::-1]]] = sign[order[::-1]]
    ahead = np.cumsum(balance[::-1], axis=0)[::-1][1:]
    behind = -np.cumsum(balance, axis=0)[:-1]
    return ((ahead > 0.0) | (_carried(first[::-1])[::-1][1:] > 0.0)) & ((behind > 0.0) | (_carried(last)[:-1] < 0.0))


def _crossings(ends: Array, outward: Array, across_m: Array) -> tuple[NDArray[np.int64], Array, Array]:
    """Every meeting of a line with a segment: the line, where along it, and whether a ray that way leaves (1) or enters (-1)."""
    step = across_m[1] - across_m[0]
    low, high = ends[:, :, 1].min(axis=1), ends[:, :, 1].max(axis=1)
    first = np.clip(np.ceil((low - across_m[0]) / step), 0, len(across_m)).astype(int)
    after = np.clip(np.ceil((high - across_m[0]) / step), 0, len(across_m)).astype(int)
    count = np.maximum(after - first, 0)
    which = np.repeat(np.arange(len(ends)), count)
    line = first[which] + np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    a, b = ends[which, 0], ends[which, 1]
    share = (across_m[line] - a[:, 1]) / (b[:, 1] - a[:, 1])
    return line, a[:, 0] + share * (b[:, 0] - a[:, 0]), np.sign(outward[which, 0])


def _carried(values: Array) -> Array:
    """Each place's own value, or where it is 0 that of the last place before it that had one."""
    place = np.where(values != 0.0, np.arange(len(values))[:, None], 0)
    return np.asarray(np.take_along_axis(values, np.maximum.accumulate(place, axis=0), axis=0))
