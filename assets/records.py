"""What is known about a heritage site, as frozen values; `assets.site` reads them from a folder.

Lengths are metres in the site frame (ENU at the origin, z = 0 on the paving), angles radians.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, TypeAlias

from assets.errors import SiteError

Epoch = Literal["roman", "today"]
Evidence = Literal["attested", "inferred", "hypothetical"]
Confidence = Literal["H", "M", "L", "D"]
Order = Literal["doric", "ionic", "bull", "corinthian"]
"""Of columns; `bull` is the Ionic one with bulls' heads beside the volutes."""
CaptionStatus = Literal["unreviewed", "reviewed"]
"""Whether a native archaeologist has read the captions."""
PointEN: TypeAlias = tuple[float, float]
PointENZ: TypeAlias = tuple[float, float, float]
Texts: TypeAlias = Mapping[str, str]
"""One text per language code: `en`, `tr`."""

LANGUAGE = "en"
"""The language that every text must have; others stand beside it."""
LANGUAGES = ("en", "tr")
"""What captions, tours and variants must have."""
MODEL = "model"
"""The kind of a monument that is brought as a GLB instead of being built."""
PAVING = "paving"
"""The kind that lies on the ground instead of standing on it; the only one that has no height."""
KINDS = (
    "altar",
    "arch",
    "basilica",
    "basin",
    "baths",
    "bouleuterion",
    "chambers",
    "court",
    "gate",
    "hall",
    MODEL,
    "nymphaeum",
    PAVING,
    "piers",
    "platform_hall",
    "prytaneion",
    "socle",
    "steps",
    "stoa",
    "temple",
    "terrace",
    "tower",
    "wall",
)


@dataclass(frozen=True)
class Origin:
    """Where the site frame is laid on the Earth (WGS84)."""

    lat_deg: float
    lon_deg: float
    h_ellipsoid_m: float
    sigma_h_m: float
    """How well the height above the ellipsoid is known."""


@dataclass(frozen=True)
class View:
    """A place to stand and a direction to look in: the start view, or a stop of the guided tour."""

    id: str
    name: Texts
    e_m: float
    n_m: float
    heading_rad: float
    """Clockwise from true north."""
    pitch_rad: float
    """Up is positive."""


@dataclass(frozen=True)
class Stop(View):
    """A stop of the guided tour."""

    monument: str
    """Id of what the stop is about."""
    text: Texts
    """To be read aloud: 40 to 80 words."""


@dataclass(frozen=True)
class Figure:
    """One measure of a monument, with where it comes from and how far to trust it."""

    value: float
    unit: str
    source: str
    """A key of the site's `sources`."""
    note: str
    """Where in the source, or by what reasoning; may be empty."""
    confidence: Confidence
    """H: excavation publication or two sources; M: one decent source or measured on the map; L: popular page; D: design value."""
    uncertainty: float


@dataclass(frozen=True)
class Footprint:
    """Corners (east, north), counter-clockwise from the south-west corner, not repeated at the end."""

    corners_en_m: tuple[PointEN, ...]
    source: str
    """A key of the site's `sources`."""
    confidence: Confidence
    uncertainty_m: float


@dataclass(frozen=True)
class Reading:
    """One of several ways in which scholars read a monument, with what speaks for it."""

    id: str
    name: Texts
    why: Texts
    """One sentence."""
    evidence: Evidence
    sources: tuple[str, ...]
    """Keys of the site's `sources`."""


@dataclass(frozen=True)
class Variant(Reading):
    """A reading that looks different: a rival reconstruction that a page can switch to."""

    figures: Mapping[str, Figure] = field(default_factory=dict)
    """Those that differ from the monument's own."""


@dataclass(frozen=True)
class ModelFile:
    """A GLB that is placed as it is: Y up, metres times `scale`, its own -Z turned to `heading_rad`."""

    file: Path
    e_m: float
    n_m: float
    z_m: float
    heading_rad: float
    """Clockwise from true north."""
    scale: float


@dataclass(frozen=True)
class Monument:
    """One building, street or open place."""

    id: str
    name: Texts
    caption: Texts
    caption_status: CaptionStatus
    kind: str
    """Which builder draws it; one of `KINDS`."""
    order: Order | None
    """Of its columns."""
    epochs: tuple[Epoch, ...]
    """The models that show it; empty for one that is known too badly to be shown."""
    evidence: Evidence
    sources: tuple[str, ...]
    footprint: Footprint
    figures: Mapping[str, Figure]
    stands_on: str | None
    """Id of the monument that carries it, whose footprint it may overlap."""
    variants: tuple[Variant, ...]
    default_variant: str | None
    """Id of one of `variants`; None where there are none."""
    attributions: tuple[Reading, ...]
    """Whose it was, where that is disputed and changes nothing that is drawn."""
    model: ModelFile | None
    """Of the kind `model`, and of no other."""

    @property
    def base_z_m(self) -> float:
        """Level of the footprint above the square's paving."""
        return self.figures["base_z_m"].value

    @property
    def height_m(self) -> float:
        """From `base_z_m` to the highest point."""
        return self.figures["height_m"].value

    def measure(self, name: str) -> float:
        """Return a figure's value in its unit; `SiteError` where the data lack what the monument's kind needs."""
        if name not in self.figures:
            raise SiteError(
                f"monument '{self.id}' of kind '{self.kind}' needs the figure '{name}'; add it to monuments.toml."
            )
        return self.figures[name].value

    def variant(self, variant_id: str | None = None) -> Variant | None:
        """Return that variant, or the default one; None where the monument has none and none is asked for.

        Raises:
            SiteError: The monument has no variant of that id.
        """
        wanted = self.default_variant if variant_id is None else variant_id
        for variant in self.variants:
            if variant.id == wanted:
                return variant
        if wanted is None:
            return None
        known = ", ".join(v.id for v in self.variants) or "none"
        raise SiteError(f"monument '{self.id}' has no variant '{wanted}'; it has: {known}.")

    def as_variant(self, variant_id: str | None = None) -> "Monument":
        """Return the monument with that variant's figures, evidence and sources; as it is where it has no variants.

        Raises:
            SiteError: The monument has no variant of that id.
        """
        variant = self.variant(variant_id)
        if variant is None:
            return self
        figures = {**self.figures, **variant.figures}
        return replace(self, figures=figures, evidence=variant.evidence, sources=variant.sources)


@dataclass(frozen=True)
class Landmark:
    """A point that stands today and that visitors can find again."""

    id: str
    name: Texts
    monument: str
    point_m: PointENZ


@dataclass(frozen=True)
class Site:
    """Everything that is known about one site."""

    id: str
    name: Texts
    folder: Path
    origin: Origin
    azimuth_rad: float
    """Of the `agora` frame's u axis, clockwise from true north."""
    time_zone: str
    eye_height_m: float
    attribution: str
    licence: str
    sources: Mapping[str, str]
    """What every source key stands for."""
    default_view: View
    tour: tuple[Stop, ...]
    ways: tuple[tuple[PointEN, ...], ...]
    """Closed rounds that visitors walk; whatever stands today keeps clear of them, and of all that a convex one encloses."""
    sights: tuple[PointENZ, ...]
    """What visitors look at: points at the height where they do so."""
    landmarks: tuple[Landmark, ...]
    """What visitors may point out to say where they look; a site may have none."""
    terrain: Mapping[str, Any]
    """The ground's description as `assets.terrain` reads it."""
    landscape: Mapping[str, Any]
    """What stands and grows around, as `assets.landscape` reads it; empty where the site has none."""
    monuments: tuple[Monument, ...]

    def monument(self, monument_id: str) -> Monument:
        """The monument of that id; `KeyError` where there is none."""
        for monument in self.monuments:
            if monument.id == monument_id:
                return monument
        raise KeyError(monument_id)

    def shown_in(self, epoch: Epoch) -> tuple[Monument, ...]:
        """The monuments that the model of that epoch shows."""
        return tuple(m for m in self.monuments if epoch in m.epochs)
