"""A monument under construction: one shape per element, each with how we know it, and what is drawn many times beside it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from assets import ambient
from assets.axes import Array
from assets.facts import monument_facts
from assets.records import Confidence, Evidence, Monument, Order, Variant
from assets.scene import Instanced, Node
from assets.shape import Mesh, Place, Shape, footprint_own_m, size_m
from assets.terrain import Terrain

BODY = ""
"""The element that is the monument's own node: what stands on its footprint."""
EVIDENCE_OF: Mapping[Confidence, Evidence] = {
    "H": "attested",
    "M": "inferred",
    "L": "hypothetical",
    "D": "hypothetical",
}
DESIGN = "design"
"""The source key of what is drawn by proportion, with no evidence."""
SPLIT_M = (2.6, 6.0, 12.0)
"""By level: how far apart corners of walls and floors may lie."""


@dataclass
class Element:
    """A part of a monument that is known in one way."""

    shape: Shape
    evidence: Evidence
    source: str
    variant: str | None
    many: list[tuple[Shape, Array]] = field(default_factory=list)
    """Parts in axes of their own, and (n, 4, 4) where their copies stand in the building's axes."""


@dataclass
class Building:
    """What a builder works on. Axes as for shapes, turned so that y = 0 is the side that `face` names."""

    monument: Monument
    level: int = 0
    elements: dict[str, Element] = field(default_factory=dict)
    side: int = 0
    chosen: str | None = None
    """The one rival reconstruction to build; all of them where it is None."""

    def face(self, side: int) -> tuple[float, float]:
        """Turn the axes so that edge `side` of the rectangle (0 its first) lies on y = 0; return width along it and depth."""
        self.side = side
        length, width = size_m(self.monument)
        return (length, width) if side % 2 == 0 else (width, length)

    def measure(self, name: str) -> float:
        """Return a figure of the monument."""
        return self.monument.measure(name)

    def order(self, usual: Order) -> Order:
        """Return the order of the monument's columns; `usual` where the data leave it open."""
        return self.monument.order or usual

    def element(
        self,
        name: str = BODY,
        by: str | None = None,
        evidence: Evidence | None = None,
        source: str | None = None,
        variant: str | None = None,
    ) -> Shape:
        """Return the shape of an element, made at its first mention.

        Args:
            name: Of the element; none is the monument's own node.
            by: The figure whose confidence says how the element is known.
            evidence: Given instead, or neither: then it is known as the monument is.
            source: Key of where it comes from; the monument's own where not given, or where the monument does not name it.
            variant: The rival reconstruction that it belongs to.
        """
        if name not in self.elements:
            told = self.monument.evidence if by is None else EVIDENCE_OF[self.monument.figures[by].confidence]
            known = source in (*self.monument.sources, DESIGN)
            usual = ", ".join(self.monument.sources) if by is None else self.monument.figures[by].source
            origin = source if source is not None and known else usual
            shape = Shape(split_m=SPLIT_M[self.level])
            self.elements[name] = Element(shape, evidence or told, origin, variant)
        return self.elements[name].shape

    def guess(self, name: str, variant: str | None = None) -> Shape:
        """Return an element of which nothing was found."""
        return self.element(name, evidence="hypothetical", source=DESIGN, variant=variant)

    def rivals(self) -> list[Variant | None]:
        """Return the reconstructions to build, the default one first: all of them, or the chosen one; None where none differ."""
        default = self.monument.variant(self.chosen)
        others = [v for v in self.monument.variants if v != default and self.chosen is None]
        return [default, *others]

    def many(
        self, name: str, part: Shape, places_m: Array, yaw_rad: Array | float = 0.0, scale: Array | None = None
    ) -> None:
        """Draw `part` at each of `places_m` (n, 3) in an element that was mentioned, turned about z and enlarged (n, 3)."""
        if len(places_m):
            self.elements[name].many.append((part, transforms(places_m, yaw_rad, scale)))

    def join(self, wing: "Building", offset_m: tuple[float, float], yaw_rad: float, z_m: float = 0.0) -> None:
        """Add all that was built in another building's axes, turned about z and moved."""
        place = np.array([[*offset_m, z_m]])
        T_own_wing = transforms(place, yaw_rad)[0]
        for name, element in wing.elements.items():
            mine = self.elements.setdefault(
                name, Element(Shape(split_m=SPLIT_M[self.level]), element.evidence, element.source, element.variant)
            )
            mine.shape.copies(element.shape, place, np.array([yaw_rad]))
            mine.many += [(part, T_own_wing @ T_wing_part) for part, T_wing_part in element.many]

    def wing(self) -> "Building":
        """Return an empty building of the same monument and level, to `join` later."""
        return Building(self.monument, self.level, chosen=self.chosen)

    def place(self) -> Place:
        """Return where the axes lie on the site."""
        monument = Place.of(self.monument)
        length, width = size_m(self.monument)
        corner = ((0.0, 0.0), (length, 0.0), (length, width), (0.0, width))[self.side]
        quarter = Place.at(0.0, 0.0, 0.0, self.side * np.pi / 2.0)
        origin = monument.R_site_own @ np.array([*corner, 0.0]) + monument.origin_m
        return Place(origin, monument.R_site_own @ quarter.R_site_own)

    def outline(self) -> Array:
        """Return the footprint (n, 2) in the monument's own axes."""
        return footprint_own_m(self.monument)

    def nodes(self, terrain: Terrain, role: str = "building", keep_many: bool = True) -> list[Node]:
        """Return one node per element that holds anything, shaded by what stands around."""
        place = self.place()
        meshes = {name: element.shape.meshes(place) for name, element in self.elements.items()}
        many = {name: _instanced(element, place) for name, element in self.elements.items()}
        meshes = self._shaded(meshes, many, terrain)
        return [
            Node(self._node_name(name), meshes[name], self._extras(name, role), many[name])
            for name in self.elements
            if meshes[name] or many[name]
        ]

    def _shaded(
        self, meshes: dict[str, list[Mesh]], many: dict[str, list[Instanced]], terrain: Terrain
    ) -> dict[str, list[Mesh]]:
        """Rivals do not shade what all have in common, nor each other."""
        common = [m for name, e in self.elements.items() if e.variant is None for m in meshes[name]]
        common += [i.expanded() for name, e in self.elements.items() if e.variant is None for i in many[name]]
        shaded: dict[str, list[Mesh]] = {}
        for variant in dict.fromkeys(e.variant for e in self.elements.values()):
            own = [name for name, e in self.elements.items() if e.variant == variant]
            around = common if variant is None else common + [m for name in own for m in meshes[name]]
            light = ambient.Light(around, terrain) if around else None
            for name in own:
                shaded[name] = [light.shaded(mesh) for mesh in meshes[name]] if light else meshes[name]
        return shaded

    def _node_name(self, element: str) -> str:
        return self.monument.id if element == BODY else f"{self.monument.id}/{element}"

    def _extras(self, name: str, role: str) -> dict[str, Any]:
        element = self.elements[name]
        told = {"role": role, "evidence": element.evidence, "source": element.source, "monument": self.monument.id}
        if element.variant is not None:
            told["variant"] = element.variant
        return (monument_facts(self.monument) | told) if name == BODY else told


Builder = Callable[[Building], None]


def transforms(places_m: Array, yaw_rad: Array | float = 0.0, scale: Array | None = None) -> Array:
    """Return (n, 4, 4): enlarged along x, y, z by `scale` (n, 3), turned about z, moved to `places_m` (n, 3)."""
    n = len(places_m)
    yaw = np.broadcast_to(np.asarray(yaw_rad, dtype=np.float64), (n,))
    size = np.ones((n, 3)) if scale is None else scale
    T = np.zeros((n, 4, 4))
    T[:, 0, 0], T[:, 0, 1], T[:, 1, 0], T[:, 1, 1] = np.cos(yaw), -np.sin(yaw), np.sin(yaw), np.cos(yaw)
    T[:, 2, 2] = T[:, 3, 3] = 1.0
    T[:, :3, :3] *= size[:, None, :]
    T[:, :3, 3] = places_m
    return T


def drawn_many(part: Shape, T_site_part: Array) -> list[Instanced]:
    """Return a part drawn at each of `T_site_part` (n, 4, 4), one mesh per material; nothing for no places."""
    return [Instanced(mesh, T_site_part) for mesh in part.meshes(Place.at(0.0, 0.0, 0.0))] if len(T_site_part) else []


def _instanced(element: Element, place: Place) -> list[Instanced]:
    """Equal parts become one mesh, wherever in the monument they stand."""
    T_site_own = np.eye(4)
    T_site_own[:3, :3], T_site_own[:3, 3] = place.R_site_own, place.origin_m
    origin = Place.at(0.0, 0.0, 0.0)
    found: dict[tuple[str, bytes, bytes], tuple[Mesh, list[Array]]] = {}
    for part, T_own_part in element.many:
        for mesh in part.meshes(origin):
            key = (mesh.material, mesh.positions_m.tobytes(), mesh.colours.tobytes())
            found.setdefault(key, (mesh, []))[1].append(T_site_own @ T_own_part)
    return [Instanced(mesh, np.concatenate(many)) for mesh, many in found.values()]
