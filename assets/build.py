"""`agora build`: a site's models from its facts, at three levels of detail, packed for a page."""

import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any

from assets.budgets import BuildReport, BuiltFile, tour_costs
from assets.errors import AssetError
from assets.gltf import Scene, write_glb
from assets.inputs import MEMORY, inputs_hash, memory_of, remembered
from assets.levels import LEVELS, PAGE_RULES, Drawn, drawn_of, with_copies_cut, with_meshes_cut
from assets.occluders import occluders
from assets.packing import pack
from assets.roman import build_roman
from assets.site import Site
from assets.surfaces import Surface, first_surfaces, full_surfaces, gpu_bytes, plain_surfaces
from assets.terrain import build_terrain
from assets.textures import Texture
from assets.today import build_today
from assets.walkable import walkable

MODELS: dict[str, Callable[..., Scene]] = {"roman": build_roman, "today": build_today}
MATERIALS_FILE = "materials.glb"
"""The full textures of all models. Level 2 has small ones of its own; the finer levels name their materials only."""
MADE, PAINTED = 0.5, 0.8
"""Shares of the work that are done when the models are made, and when only packing is left."""
PACKED = ".packed.glb"
FOR_ANY_READER = ("occluders",)
"""The operator's console shows these, and cannot unpack."""


def build(site: Site, folder: Path, progress: Callable[[float], None]) -> BuildReport:
    """Write every model of a site into `folder` and return what was written; the same facts give the same bytes.

    Where nothing has changed since the last build into that folder, nothing is made.

    Args:
        site: The facts.
        folder: Made where it does not exist; a file there is replaced only by a whole one.
        progress: Called with the share that is done.

    Raises:
        SiteError: The facts do not suffice.
        PackerMissing: There is no Node.js to pack with.
        AssetError: The folder cannot be made or written.
    """
    key = inputs_hash(site.folder, folder)
    known = remembered(folder, key)
    if known is not None:
        progress(1.0)
        return known
    try:
        folder.mkdir(parents=True, exist_ok=True)  # before the half minute that the models take
    except OSError as exc:
        raise AssetError(f"{folder} cannot be made ({exc.strerror}): name another folder.") from exc
    with tempfile.TemporaryDirectory(prefix="agora-build-") as raw:
        made = _Made(site, Path(raw))
        jobs = [(model, level) for model in MODELS for level in LEVELS]
        for i, (model, level) in enumerate(jobs):
            made.add_model(model, level, partial(_part, progress, MADE * i / len(jobs), MADE / len(jobs)))
        made.add_materials()
        made.add_proxies()
        progress(PAINTED)
        pack(
            {path: path.with_suffix(PACKED) for path in made.to_pack},
            partial(_part, progress, PAINTED, 0.99 - PAINTED),
        )
        files = tuple(made.move(path, folder) for path in made.files)
    report = BuildReport(files, *made.worst_costs(), gpu_bytes(made.surfaces.values()))
    _write(folder / MEMORY, memory_of(key, report))
    progress(1.0)
    return report


def _part(progress: Callable[[float], None], start: float, size: float, share: float) -> None:
    progress(start + size * share)


class _Made:
    """Raw files of a build in a folder of their own, and what is known of them."""

    def __init__(self, site: Site, folder: Path) -> None:
        self.site = site
        self.folder = folder
        self.files: dict[Path, tuple[str, int]] = {}
        """Model and level of each file."""
        self.to_pack: list[Path] = []
        self.drawn: dict[str, dict[int, list[Drawn]]] = {}
        self.surfaces: dict[str, Surface] = {}
        self._textures: dict[str, Texture] = {}
        self._today: Scene | None = None

    def add_model(self, model: str, level: int, progress: Callable[[float], None]) -> None:
        """Make a model at one level."""
        whole = MODELS[model](self.site, progress, level=level)
        self._today = whole if (model, level) == ("today", 0) else self._today
        scene = with_meshes_cut(whole)
        self._textures |= scene.textures
        self.drawn.setdefault(model, {})[level] = [drawn_of(node) for node in with_copies_cut(scene).nodes]
        looks = first_surfaces(scene.textures) if level == LEVELS[-1] else plain_surfaces(scene.textures)
        self._write(f"{model}.{level}.glb", (model, level), write_glb(scene, self._extras(model), looks))

    def add_materials(self) -> None:
        """Write the full textures of all that has been made."""
        self.surfaces = full_surfaces(self._textures)
        data = write_glb(Scene([], {}), self._extras("materials"), self.surfaces)
        self._write(MATERIALS_FILE, ("materials", 0), data, packed=False)

    def add_proxies(self) -> None:
        """Write what hides and what carries a visitor: shapes without looks."""
        for name, scene in (("occluders", occluders(self.site, self._today)), ("walkable", walkable(self.site))):
            data = write_glb(scene, self._extras(name), plain_surfaces(scene.textures))
            self._write(f"{name}.glb", (name, 0), data, packed=name not in FOR_ANY_READER)

    def move(self, path: Path, folder: Path) -> BuiltFile:
        """Move a finished file to where it belongs."""
        target = folder / path.name
        data = (path.with_suffix(PACKED) if path in self.to_pack else path).read_bytes()
        _write(target, data)
        model, level = self.files[path]
        return BuiltFile(_relative(target, self.site.folder), len(data), sha256(data).hexdigest(), model, level)

    def worst_costs(self) -> tuple[int, int]:
        """Return the most draw calls and the most triangles of any view of the tour, in either model."""
        terrain = build_terrain(self.site)
        views = (self.site.default_view, *self.site.tour)
        ground_z_m = {view.id: float(terrain.ground_z_m(view.e_m, view.n_m)) for view in views}
        costs = [tour_costs(self.site, levels, ground_z_m) for levels in self.drawn.values()]
        return max(calls for calls, _ in costs), max(triangles for _, triangles in costs)

    def _extras(self, model: str) -> dict[str, Any]:
        site = self.site
        about = {"site": site.id, "model": model, "attribution": site.attribution, "licence": site.licence}
        return about | PAGE_RULES | {"materials": MATERIALS_FILE}

    def _write(self, name: str, of: tuple[str, int], data: bytes, packed: bool = True) -> None:
        path = self.folder / name
        path.write_bytes(data)
        self.files[path] = of
        self.to_pack += [path] if packed else []


def _relative(path: Path, folder: Path) -> str:
    return path.relative_to(folder).as_posix() if path.is_relative_to(folder) else path.name


def _write(path: Path, data: bytes) -> None:
    """Write beside the file and rename, so that no reader ever sees half of it."""
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(data)
        part.replace(path)
    except OSError as exc:
        with suppress(OSError):
            part.unlink()
        raise AssetError(
            f"{path} cannot be written ({exc.strerror}); free the space or change the permissions."
        ) from exc
