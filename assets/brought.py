"""Models that a site brings along: a GLB of any origin, read and laid on the site as it is.

A brought model keeps its shape; of its looks it keeps one colour per corner, from its colours, materials or pictures.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import MultiPoint, Polygon
from shapely.geometry.polygon import orient

from assets.axes import Array
from assets.errors import SiteError
from assets.records import Figure, Footprint, ModelFile

if TYPE_CHECKING:
    import trimesh  # half of what a command takes to start, and few sites bring models: loaded with the first one

R_SITE_GLTF = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From glTF's axes (x east, y up, z south) to the site's (x east, y north, z up)."""
MAGIC = b"glTF"


@dataclass(frozen=True)
class Piece:
    """Triangles of a brought model, site frame."""

    positions_m: Array
    """(n, 3)"""
    normals: Array
    """(n, 3), unit."""
    colours: NDArray[np.uint8]
    """(n, 3), linear."""
    triangles: NDArray[np.int64]
    """(m, 3), counter-clockwise from outside."""


@dataclass(frozen=True)
class Measured:
    """What a brought model says of itself."""

    footprint: Footprint
    figures: Mapping[str, Figure]
    """`base_z_m` and `height_m`."""


def pieces(model: ModelFile, key: str, named_in: Path) -> list[Piece]:
    """Return a model on the site.

    Args:
        model: File and place.
        key: The field that names it, for the complaint.
        named_in: The file that holds that field.

    Raises:
        SiteError: The file is missing, is no GLB, or holds no triangles.
    """
    start = f"{named_in}: '{key}' names {model.file.name}, which"
    scene = _loaded(model.file, start)
    found = [_piece(mesh, T_gltf_part, model) for mesh, T_gltf_part in _placed(scene)]
    if not found:
        raise SiteError(f"{start} holds no triangles; export it again, without compression.")
    if not all(np.isfinite(piece.positions_m).all() for piece in found):
        raise SiteError(f"{start} holds corners that are no numbers; export it again.")
    return found


def measure(model: ModelFile, source: str, key: str, named_in: Path) -> Measured:
    """Return the outline, floor and height of a model as it stands on the site; see `pieces` for `key` and errors."""
    points = np.concatenate([piece.positions_m for piece in pieces(model, key, named_in)])
    hull = MultiPoint(points[:, :2]).convex_hull
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    if not isinstance(hull, Polygon) or high <= low:
        raise SiteError(
            f"{named_in}: '{key}' names {model.file.name}, which is flat; a monument needs ground and height."
        )
    corners = np.array(orient(hull).exterior.coords)[:-1]
    start = int(np.argmin(corners.sum(axis=1)))
    outline = tuple((float(e), float(n)) for e, n in np.roll(corners, -start, axis=0))
    note = f"measured on {model.file.name}"
    return Measured(
        Footprint(outline, source, "M", 0.0),
        {
            "base_z_m": Figure(low, "m", source, note, "M", 0.0),
            "height_m": Figure(high - low, "m", source, note, "M", 0.0),
        },
    )


def _loaded(file: Path, start: str) -> "trimesh.Scene":
    from trimesh import load_scene

    try:
        with file.open("rb") as stream:
            if stream.read(4) != MAGIC:
                raise SiteError(f"{start} is no GLB (binary glTF 2.0); export it as one file that ends in .glb.")
        return load_scene(file, file_type="glb", process=False)
    except OSError as exc:
        raise SiteError(f"{start} cannot be read ({exc.strerror}); put it into the site's folder.") from exc
    except SiteError:
        raise
    except Exception as exc:  # a reader of other people's files: whatever it trips over, the file is broken
        raise SiteError(f"{start} is a broken GLB; export it again, without compression.") from exc


def _placed(scene: "trimesh.Scene") -> Iterator[tuple["trimesh.Trimesh", Array]]:
    from trimesh import Trimesh

    for name in scene.graph.nodes_geometry:
        T_gltf_part, geometry = scene.graph[name]
        mesh = scene.geometry[geometry]
        if isinstance(mesh, Trimesh) and len(mesh.faces):
            yield mesh, np.asarray(T_gltf_part, dtype=np.float64)


def _piece(mesh: "trimesh.Trimesh", T_gltf_part: Array, model: ModelFile) -> Piece:
    sin, cos = np.sin(model.heading_rad), np.cos(model.heading_rad)
    turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) @ R_SITE_GLTF
    linear = turn @ T_gltf_part[:3, :3]
    moved = np.asarray(mesh.vertices) @ T_gltf_part[:3, :3].T + T_gltf_part[:3, 3]
    normals = np.asarray(mesh.vertex_normals) @ np.linalg.inv(linear)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    faces = np.asarray(mesh.faces, dtype=np.int64)
    return Piece(
        model.scale * moved @ turn.T + (model.e_m, model.n_m, model.z_m),
        normals,
        _colours(mesh),
        faces if np.linalg.det(linear) > 0.0 else faces[:, ::-1],
    )


def _colours(mesh: "trimesh.Trimesh") -> NDArray[np.uint8]:
    """One linear colour per corner; white where the model has none."""
    visual: Any = mesh.visual
    picture = getattr(getattr(visual, "material", None), "baseColorTexture", None)
    coloured = visual.to_color() if visual.kind == "texture" and getattr(visual, "uv", None) is not None else visual
    if visual.kind is None:
        return np.full((len(mesh.vertices), 3), 255, dtype=np.uint8)
    if coloured.kind == "texture":
        rgb = np.tile(np.asarray(visual.material.main_color)[:3], (len(mesh.vertices), 1))
    else:
        rgb = np.asarray(coloured.vertex_colors)[:, :3]
    if picture is None:
        return rgb.astype(np.uint8)
    share = rgb / 255.0  # a picture's colours are sRGB
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.asarray((linear * 255.0).round(), dtype=np.uint8)
