"""Levels of detail: wide things cut into cells, and what a view costs when every thing is drawn at the level for its distance.

The page (`web/src/levels.ts`) chooses by the same rule; the distances reach it in the files.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assets.axes import Array
from assets.scene import Instanced, Node, Scene
from assets.shape import Mesh
from assets.site import View

LEVELS = (0, 1, 2)
"""The finest, the middle one, the first paint."""
REACH_M = (30.0, 80.0)
"""Up to these distances from the eye a thing is drawn at level 0, at level 1; at level 2 beyond."""
CELL_M, WIDE_CELL_M, NEAR_M = 48.0, 288.0, 144.0
"""Sides of the cells within `NEAR_M` of the site's origin, east or north, and of those beyond."""
FAR = 1000
"""Added to the numbers of the wide cells, so that they are none of the others'."""
MANY_TRIANGLES = 2500
"""All copies of a mesh together have at least this many where the page draws them as copies; fewer it joins into one mesh."""
WIDTH_RAD, ASPECT = np.radians(75.0), 16.0 / 9.0
"""The field of view across, and the shape of the screen, that costs are told for."""


PAGE_RULES = {
    "level_reach_m": list(REACH_M),
    "many_triangles": MANY_TRIANGLES,
    "cells": {"near_m": NEAR_M, "side_m": CELL_M, "wide_side_m": WIDE_CELL_M, "far": FAR},
}
"""What the page must know of all this, as it stands in the files."""


def group_of(name: str, extras: Mapping[str, Any]) -> str:
    """Return what a node changes its level together with: its monument, else itself."""
    return str(extras.get("monument") or name.partition("/")[0])


def with_meshes_cut(scene: Scene) -> Scene:
    """Return the scene with the plain meshes of wide things cut into square cells, named `NAME@COLUMN,ROW`."""
    return replace(scene, nodes=[part for node in scene.nodes for part in _cut_meshes(node)])


def with_copies_cut(scene: Scene) -> Scene:
    """Return the scene with the copies of wide things sorted into the same cells; a page does this by itself."""
    return replace(scene, nodes=[part for node in scene.nodes for part in _cut_copies(node)])


def _is_wide(node: Node) -> bool:
    return not node.extras.get("monument") and node.extras.get("role") != "backdrop" and "@" not in node.name


def _cut_meshes(node: Node) -> list[Node]:
    if not _is_wide(node):
        return [node]
    found: dict[tuple[int, int], list[Mesh]] = {}
    for mesh in node.meshes:
        for key, chosen in _by_cell(mesh.positions_m[mesh.triangles].mean(axis=1)):
            found.setdefault(key, []).append(_part(mesh, chosen))
    rest = [replace(node, meshes=())] if node.instances else []
    return [*rest, *(_cell(node, key, meshes, ()) for key, meshes in sorted(found.items()))]


def _cut_copies(node: Node) -> list[Node]:
    if not _is_wide(node):
        return [node]
    found: dict[tuple[int, int], list[Instanced]] = {}
    for part in node.instances:
        for key, chosen in _by_cell(part.T_site_part[:, :3, 3]):
            found.setdefault(key, []).append(Instanced(part.mesh, part.T_site_part[chosen]))
    rest = [replace(node, instances=())] if node.meshes else []
    return [*rest, *(_cell(node, key, (), parts) for key, parts in sorted(found.items()))]


def _cell(node: Node, key: tuple[int, int], meshes: Sequence[Mesh], parts: Sequence[Instanced]) -> Node:
    return replace(node, name=f"{node.name}@{key[0]},{key[1]}", meshes=meshes, instances=parts)


def _by_cell(points_m: NDArray[Any]) -> Iterable[tuple[tuple[int, int], NDArray[np.bool_]]]:
    near = np.abs(points_m[:, :2]).max(axis=1, keepdims=True) < NEAR_M
    wide = np.floor(points_m[:, :2] / WIDE_CELL_M).astype(int) + FAR
    cells = np.where(near, np.floor(points_m[:, :2] / CELL_M).astype(int), wide)
    for i, j in np.unique(cells, axis=0):
        yield (int(i), int(j)), (cells == (i, j)).all(axis=1)


def _part(mesh: Mesh, chosen: NDArray[np.bool_]) -> Mesh:
    used, renumbered = np.unique(mesh.triangles[chosen], return_inverse=True)
    return Mesh(
        mesh.material,
        mesh.positions_m[used],
        mesh.normals[used],
        mesh.uvs[used],
        mesh.colours[used],
        renumbered.reshape(-1, 3).astype(np.uint32),
    )


@dataclass(frozen=True)
class Drawn:
    """What one node costs at one level."""

    group: str
    variant: str | None
    low_m: Array
    high_m: Array
    """(3,) each, site frame."""
    triangles: int
    batches: frozenset[str]
    """Materials of its plain meshes and few copies: the page draws all such of one level and material in one call."""
    copies: int
    """Parts with so many copies that each is a draw call of its own."""


def drawn_of(node: Node) -> Drawn:
    """Return what a node costs."""
    boxes = [mesh.positions_m for mesh in node.meshes] + [_corners(part) for part in node.instances]
    points = np.concatenate(boxes).astype(np.float64) if boxes else np.zeros((1, 3))
    return Drawn(
        group_of(node.name, node.extras),
        node.extras.get("variant"),
        points.min(axis=0),
        points.max(axis=0),
        node.triangles,
        frozenset(
            [m.material for m in node.meshes] + [p.mesh.material for p in node.instances if not _is_drawn_alone(p)]
        ),
        sum(_is_drawn_alone(part) for part in node.instances),
    )


def _is_drawn_alone(part: Instanced) -> bool:
    return part.triangles >= MANY_TRIANGLES


def _corners(part: Instanced) -> Array:
    low, high = part.mesh.positions_m.min(axis=0), part.mesh.positions_m.max(axis=0)
    corners = np.stack(np.meshgrid(*zip(low, high, strict=True)), -1).reshape(-1, 3)
    T = part.T_site_part
    return np.asarray(corners @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]).reshape(-1, 3)


def cost_of(view: View, eye_z_m: float, levels: Mapping[int, Sequence[Drawn]]) -> tuple[int, int]:
    """Return draw calls and triangles of a view, all variants but each monument's first left out."""
    eye = np.array([view.e_m, view.n_m, eye_z_m])
    boxes = _group_boxes(drawn for level in levels.values() for drawn in level)
    chosen = {group: level_at(_distance_m(eye, *box)) for group, box in boxes.items()}
    first: dict[str, str] = {}
    planes = _frustum(view)
    calls, triangles, batches = 0, 0, set()
    for level, things in levels.items():
        for drawn in things:
            if drawn.variant is not None and first.setdefault(drawn.group, drawn.variant) != drawn.variant:
                continue
            if chosen[drawn.group] != level or _hidden(eye, planes, drawn):
                continue
            calls, triangles = calls + drawn.copies, triangles + drawn.triangles
            batches |= {(level, material) for material in drawn.batches}
    return calls + len(batches), triangles


def level_at(distance_m: float) -> int:
    """Return the level for a distance from the eye."""
    return sum(distance_m > reach_m for reach_m in REACH_M)


def _group_boxes(things: Iterable[Drawn]) -> dict[str, tuple[Array, Array]]:
    boxes: dict[str, tuple[Array, Array]] = {}
    for drawn in things:
        low, high = boxes.get(drawn.group, (drawn.low_m, drawn.high_m))
        boxes[drawn.group] = np.minimum(low, drawn.low_m), np.maximum(high, drawn.high_m)
    return boxes


def _distance_m(eye: Array, low: Array, high: Array) -> float:
    return float(np.linalg.norm(np.maximum(np.maximum(low - eye, eye - high), 0.0)))


def _frustum(view: View) -> Array:
    """Inward normals (5, 3) of the sides of the view's pyramid and of the plane through the eye."""
    sin, cos, up, flat = (
        f(a)
        for a, f in (
            (view.heading_rad, np.sin),
            (view.heading_rad, np.cos),
            (view.pitch_rad, np.sin),
            (view.pitch_rad, np.cos),
        )
    )
    ahead = np.array([sin * flat, cos * flat, up])
    right = np.array([cos, -sin, 0.0])
    above = np.cross(right, ahead)
    x = np.tan(WIDTH_RAD / 2.0)
    y = x / ASPECT
    return np.stack([ahead, ahead * x + right, ahead * x - right, ahead * y + above, ahead * y - above])


def _hidden(eye: Array, planes: Array, drawn: Drawn) -> bool:
    corners = np.stack(np.meshgrid(*zip(drawn.low_m, drawn.high_m, strict=True)), -1).reshape(-1, 3) - eye
    return bool(((corners @ planes.T) < 0.0).all(axis=0).any())
