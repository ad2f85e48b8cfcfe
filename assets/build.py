"""`agora build`: a site's models from its facts, and what they weigh."""

import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

from assets.errors import AssetError
from assets.gltf import Scene, write_glb
from assets.roman import build_roman
from assets.site import Site
from assets.today import build_today

MODELS: dict[str, Callable[[Site, Callable[[float], None]], Scene]] = {"roman": build_roman, "today": build_today}
FIRST_PAINT = "roman"
"""The model that a page needs before it can draw anything."""


@dataclass(frozen=True)
class BuiltFile:
    """One file of a build."""

    path: str
    """Relative to the site's folder."""
    bytes: int
    sha256: str
    model: str
    level: int
    """0 is the finest."""


@dataclass(frozen=True)
class BuildReport:
    """What was built. Draw calls, triangles and graphics memory are those of the model that a page draws."""

    files: tuple[BuiltFile, ...]
    draw_calls: int
    triangles: int
    gpu_bytes: int

    @property
    def total_bytes(self) -> int:
        """Size of all files."""
        return sum(file.bytes for file in self.files)

    @property
    def first_paint_bytes(self) -> int:
        """Size of what a page loads before it can draw."""
        return sum(file.bytes for file in self.files if file.model == FIRST_PAINT)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {
            "files": [asdict(file) for file in self.files],
            "total_bytes": self.total_bytes,
            "first_paint_bytes": self.first_paint_bytes,
            "draw_calls": self.draw_calls,
            "triangles": self.triangles,
            "gpu_bytes": self.gpu_bytes,
        }


def build(site: Site, folder: Path, progress: Callable[[float], None]) -> BuildReport:
    """Write every model of a site into `folder` and return what was written; the same facts give the same bytes.

    Args:
        site: The facts.
        folder: Made where it does not exist; a file there is replaced only by a whole one.
        progress: Called with the share that is done.

    Raises:
        SiteError: The facts do not suffice.
        AssetError: The folder cannot be written.
    """
    files, drawn = [], Scene([], {})
    for i, (name, make) in enumerate(MODELS.items()):
        scene = make(site, partial(_report, progress, i))
        data = write_glb(
            scene, {"site": site.id, "model": name, "attribution": site.attribution, "licence": site.licence}
        )
        path = folder / f"{name}.glb"
        _write(path, data)
        files.append(BuiltFile(_relative(path, site.folder), len(data), sha256(data).hexdigest(), name, 0))
        drawn = scene if name == FIRST_PAINT else drawn
        progress((i + 1) / len(MODELS))
    return BuildReport(
        tuple(files),
        draw_calls=sum(len(node.meshes) for node in drawn.nodes),
        triangles=sum(node.triangles for node in drawn.nodes),
        gpu_bytes=_gpu_bytes(drawn),
    )


def _report(progress: Callable[[float], None], before: int, share: float) -> None:
    progress((before + 0.9 * share) / len(MODELS))


def _relative(path: Path, folder: Path) -> str:
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else path.name


def _write(path: Path, data: bytes) -> None:
    """Write beside the file and rename, so that no reader ever sees half of it."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(data)
        part.replace(path)
    except OSError as exc:
        with suppress(OSError):
            part.unlink()
        raise AssetError(
            f"{path} cannot be written ({exc.strerror}); free the space or change the permissions."
        ) from exc


def _gpu_bytes(scene: Scene) -> int:
    """Vertices and indices as they stand in the file, textures as four bytes a pixel with their smaller copies."""
    meshes = [mesh for node in scene.nodes for mesh in node.meshes]
    arrays = sum(
        len(m.positions_m) * (12 + 12 + 8 + 4) + m.triangles.size * (2 if len(m.positions_m) <= 65535 else 4)
        for m in meshes
    )
    return arrays + sum(texture.size * 16 // 9 for texture in scene.textures.values())
