"""The ground: levels of rectangles blended into a height field on a grid, the same for the models and for whoever walks on it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array, agora_from_site
from assets.errors import SiteError
from assets.site import Site
from assets.textures import noise

BLEND_POWER = 3.0
"""Inverse distance weights: 3 keeps slopes even; 2 pulls the whole ground to one mean."""
MIN_GAP_M = 0.4
"""Regular grid lines nearer than this to an edge are left out: slivers shade badly."""
RELIEF_CELLS, RELIEF_CELL_M, RELIEF_GROWS_M = 64, 20.0, 180.0
"""Of the hills' unevenness: noise on so many cells a side, of that size, at full height from that far out."""


@dataclass(frozen=True)
class Terrain:
    """Heights on a grid of unequal steps in the `agora` frame; each cell is split from its first to its last corner."""

    azimuth_rad: float
    u_m: Array
    v_m: Array
    z_m: Array
    """(len(u_m), len(v_m)) above the paving of the square."""

    @overload
    def ground_z_m(self, east_m: float, north_m: float) -> float: ...
    @overload
    def ground_z_m(self, east_m: Array, north_m: Array) -> Array: ...
    def ground_z_m(self, east_m: float | Array, north_m: float | Array) -> float | Array:
        """Return the height of the drawn ground, exactly on its triangles; beyond the grid that of the nearest edge.

        Args:
            east_m: Scalar or array, site frame.
            north_m: The same shape.

        Returns:
            A float for scalars, else an array of the same shape; metres above the paving of the square.
        """
        uv = agora_from_site(self.azimuth_rad) @ np.stack([np.ravel(east_m), np.ravel(north_m)]).astype(np.float64)
        z = self._at(np.clip(uv[0], self.u_m[0], self.u_m[-1]), np.clip(uv[1], self.v_m[0], self.v_m[-1]))
        return float(z[0]) if np.ndim(east_m) == 0 else z.reshape(np.shape(east_m))

    def _at(self, u: Array, v: Array) -> Array:
        i = np.clip(np.searchsorted(self.u_m, u, side="right") - 1, 0, len(self.u_m) - 2)
        j = np.clip(np.searchsorted(self.v_m, v, side="right") - 1, 0, len(self.v_m) - 2)
        a = (u - self.u_m[i]) / (self.u_m[i + 1] - self.u_m[i])
        b = (v - self.v_m[j]) / (self.v_m[j + 1] - self.v_m[j])
        first, last = self.z_m[i, j], self.z_m[i + 1, j + 1]
        lower = first + a * (self.z_m[i + 1, j] - first) + b * (last - self.z_m[i + 1, j])
        upper = first + b * (self.z_m[i, j + 1] - first) + a * (last - self.z_m[i, j + 1])
        return np.where(a >= b, lower, upper)

    def grid_points_m(self) -> Array:
        """Return the grid's corners, (len(u_m), len(v_m), 3), site frame."""
        u, v = np.meshgrid(self.u_m, self.v_m, indexing="ij")
        en = np.stack([u, v], axis=-1) @ agora_from_site(self.azimuth_rad)
        return np.concatenate([en, self.z_m[..., None]], axis=-1)


def build_terrain(site: Site) -> Terrain:
    """Return the site's ground.

    Raises:
        SiteError: `[terrain]` of site.toml lacks something or holds something other than numbers.
    """
    levels = numbers(site.terrain, "terrain", "levels", (None, 6))
    u_extent, v_extent = (
        numbers(site.terrain, "terrain", "u_extent_m", (2,)),
        numbers(site.terrain, "terrain", "v_extent_m", (2,)),
    )
    fine, coarse = (
        numbers(site.terrain, "terrain", "fine_step_m", ()),
        numbers(site.terrain, "terrain", "coarse_step_m", ()),
    )
    u_m = _lines(
        levels[:, 0:2], u_extent, numbers(site.terrain, "terrain", "fine_u_m", (2,)), float(fine), float(coarse)
    )
    v_m = _lines(
        levels[:, 2:4], v_extent, numbers(site.terrain, "terrain", "fine_v_m", (2,)), float(fine), float(coarse)
    )
    u, v = np.meshgrid(u_m, v_m, indexing="ij")
    relief = float(numbers(site.terrain, "terrain", "relief_m", ()))
    known = numbers(site.terrain, "terrain", "relief_beyond_m", (4,))
    return Terrain(site.azimuth_rad, u_m, v_m, _blend(levels, u, v) + relief * _relief(known, u, v))


def _relief(known: Array, u: Array, v: Array) -> Array:
    """Hummocks and gullies at (u, v): deviation 1 far out, none inside the rectangle whose levels are known."""
    u0, u1, v0, v1 = known
    away = np.hypot(np.maximum(np.maximum(u0 - u, u - u1), 0.0), np.maximum(np.maximum(v0 - v, v - v1), 0.0))
    field = noise(401, RELIEF_CELLS, 2, RELIEF_CELLS // 4, 1.3)
    i, j = (np.floor(x / RELIEF_CELL_M).astype(int) % RELIEF_CELLS for x in (u, v))
    return np.asarray(field[i, j] * np.clip(away / RELIEF_GROWS_M, 0.0, 1.0))


def numbers(table: Mapping[str, Any], name: str, key: str, shape: tuple[int | None, ...]) -> Array:
    """Return a field of site.toml's table `name` as an array of that shape (None: any length over 0)."""
    wanted = " by ".join("n" if n is None else str(n) for n in shape) or "one"
    try:
        values: NDArray[np.float64] = np.array(table[key], dtype=np.float64)
    except KeyError as exc:
        raise SiteError(f"site.toml has no '{name}.{key}'; add it ({wanted} numbers).") from exc
    except (TypeError, ValueError) as exc:
        raise SiteError(f"site.toml: '{name}.{key}' must hold {wanted} numbers.") from exc
    fits = values.ndim == len(shape) and all(n is None or n == m for n, m in zip(shape, values.shape, strict=True))
    if not fits or values.size == 0 or not np.isfinite(values).all():
        raise SiteError(f"site.toml: '{name}.{key}' must hold {wanted} numbers.")
    if key.endswith("step_m") and not values > 0.0:
        raise SiteError(f"site.toml: '{name}.{key}' must be more than 0 metres.")
    return values


def _lines(edges: Array, extent: Array, fine: Array, fine_step_m: float, coarse_step_m: float) -> Array:
    """Grid lines along one axis: every rectangle's edges, and regular ones between that keep clear of them."""
    kept = np.unique(np.concatenate([edges.ravel(), extent]))
    spans = (
        (extent[0], fine[0], coarse_step_m),
        (fine[0], fine[1], fine_step_m),
        (fine[1], extent[1], coarse_step_m),
    )
    regular = np.concatenate([np.linspace(a, b, max(2, math.ceil((b - a) / step))) for a, b, step in spans])
    clear = np.abs(regular[:, None] - kept[None, :]).min(axis=1) > MIN_GAP_M
    lines = np.unique(np.concatenate([kept, regular[clear]]))
    return np.asarray(lines[(lines >= extent[0]) & (lines <= extent[1])])


def _blend(levels: Array, u: Array, v: Array) -> Array:
    """Heights at (u, v) by inverse distance to the rectangles; exactly a rectangle's plane inside it."""
    weights, total = np.zeros_like(u), np.zeros_like(u)
    for u0, u1, v0, v1, z0, z1 in levels:
        along = np.clip((u - u0) / (u1 - u0), 0.0, 1.0)
        distance = np.hypot(np.maximum(np.maximum(u0 - u, u - u1), 0.0), np.maximum(np.maximum(v0 - v, v - v1), 0.0))
        weight = np.maximum(distance, 1e-3) ** -BLEND_POWER
        weights += weight
        total += weight * (z0 + along * (z1 - z0))
    return total / weights
