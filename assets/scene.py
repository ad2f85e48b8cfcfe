"""A scene before it is written: named nodes of meshes, and of meshes that are drawn many times."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from assets.shape import Mesh, unit
from assets.textures import Texture


@dataclass(frozen=True)
class Instanced:
    """A mesh in the axes of a part, drawn once per row of `T_site_part`."""

    mesh: Mesh
    T_site_part: NDArray[np.float64]
    """(n, 4, 4): turned, enlarged along the part's own axes and moved; never sheared or mirrored."""

    def __post_init__(self) -> None:
        if self.T_site_part.ndim != 3 or self.T_site_part.shape[1:] != (4, 4) or not len(self.T_site_part):
            raise ValueError(f"expected transforms (n, 4, 4) with n > 0, got {self.T_site_part.shape}")

    @property
    def triangles(self) -> int:
        """How many triangles all its copies are drawn with."""
        return len(self.mesh.triangles) * len(self.T_site_part)

    def expanded(self) -> Mesh:
        """Return all copies as one mesh, site frame."""
        mesh, k, n = self.mesh, len(self.T_site_part), len(self.mesh.positions_m)
        turn, move = self.T_site_part[:, :3, :3], self.T_site_part[:, :3, 3]
        points = mesh.positions_m.astype(np.float64) @ turn.transpose(0, 2, 1) + move[:, None]
        normals = unit(mesh.normals.astype(np.float64) @ np.linalg.inv(turn))
        triangles = mesh.triangles[None].astype(np.int64) + n * np.arange(k)[:, None, None]
        return Mesh(
            mesh.material,
            points.reshape(-1, 3).astype(np.float32),
            normals.reshape(-1, 3).astype(np.float32),
            np.tile(mesh.uvs, (k, 1)),
            np.tile(mesh.colours, (k, 1)),
            triangles.reshape(-1, 3).astype(np.uint32),
        )


@dataclass(frozen=True)
class Node:
    """One named thing of a scene."""

    name: str
    meshes: Sequence[Mesh]
    extras: Mapping[str, Any] = field(default_factory=dict)
    instances: Sequence[Instanced] = ()

    @property
    def triangles(self) -> int:
        """How many triangles it is drawn with."""
        return sum(len(mesh.triangles) for mesh in self.meshes) + sum(part.triangles for part in self.instances)

    @property
    def materials(self) -> list[str]:
        """Names of what it is made of, in the order of their first use."""
        return list(dict.fromkeys([m.material for m in self.meshes] + [p.mesh.material for p in self.instances]))


@dataclass(frozen=True)
class Scene:
    """What a file holds: nodes, and the textures by material."""

    nodes: Sequence[Node]
    textures: Mapping[str, Texture]


def content_of(scene: Scene) -> Iterator[bytes]:
    """Yield all that a picture of a scene depends on, for a hash."""
    for node in scene.nodes:
        for mesh in [*node.meshes, *(part.mesh for part in node.instances)]:
            yield mesh.material.encode()
            for array in (mesh.positions_m, mesh.normals, mesh.uvs, mesh.colours, mesh.triangles):
                yield array.tobytes()
        yield from (part.T_site_part.tobytes() for part in node.instances)
    for name, texture in scene.textures.items():
        yield name.encode() + texture.tobytes()


def expanded(scene: Scene) -> Scene:
    """Return the same scene without instances, every copy a mesh of its own: for what cannot draw one mesh many times."""
    return replace(scene, nodes=[replace(node, meshes=_all_meshes(node), instances=()) for node in scene.nodes])


def _all_meshes(node: Node) -> list[Mesh]:
    return [*node.meshes, *(part.expanded() for part in node.instances)]
