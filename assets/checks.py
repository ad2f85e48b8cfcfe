"""What a site's parts must be to each other: footprints that do not overlap, and ids that exist."""

from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

from shapely.geometry import Polygon
from shapely.validation import explain_validity

from assets.errors import SiteError
from assets.records import Landmark, Monument, Stop

TOUCH_M = 0.1
"""Footprints that reach into each other by up to twice this do not overlap: neighbours share walls, and maps have edges."""


def check_monuments(file: Path, monuments: Sequence[Monument]) -> None:
    """Refuse footprints that are no outlines or overlap, and bearers that do not exist.

    Footprints may overlap where one monument says that it stands on the other, or where no model shows both.

    Raises:
        SiteError: The sentence names file, key and reason.
    """
    by_id = {m.id: m for m in monuments}
    outlines = {m.id: _outline(file, m) for m in monuments}
    for m in monuments:
        if m.stands_on is not None and (m.stands_on not in by_id or m.stands_on == m.id):
            raise SiteError(f"{file}: '{m.id}.stands_on' is {m.stands_on!r}, which is no other monument of this file.")
    for a, b in combinations(monuments, 2):
        together = set(a.epochs) & set(b.epochs)
        if not together or b.id in _bearers(a, by_id) or a.id in _bearers(b, by_id):
            continue
        common = outlines[a.id].intersection(outlines[b.id])
        if not common.buffer(-TOUCH_M).is_empty:
            raise SiteError(
                f"{file}: '{b.id}.footprint' overlaps that of '{a.id}' by {common.area:.1f} square metres; "
                f'move one, or add to the upper one: stands_on = "{a.id}".'
            )


def check_tour(file: Path, stops: Sequence[Stop], monuments: Sequence[Monument]) -> None:
    """Refuse stops about monuments that do not exist, and two stops of one id.

    Raises:
        SiteError: The sentence names file, key and reason.
    """
    known = {m.id for m in monuments}
    for i, stop in enumerate(stops):
        if stop.monument not in known:
            raise SiteError(f"{file}: 'tour[{i}].monument' is {stop.monument!r}, which monuments.toml does not have.")
        if stop.id in {other.id for other in stops[:i]}:
            raise SiteError(f"{file}: 'tour[{i}].id' is {stop.id!r}, which an earlier stop has already.")


def check_landmarks(file: Path, landmarks: Sequence[Landmark], monuments: Sequence[Monument]) -> None:
    """Refuse landmarks of monuments that do not stand today, and two of one id.

    Raises:
        SiteError: The sentence names file, key and reason.
    """
    standing = {m.id for m in monuments if "today" in m.epochs}
    for i, landmark in enumerate(landmarks):
        if landmark.monument not in standing:
            raise SiteError(
                f"{file}: 'landmark[{i}].monument' is {landmark.monument!r}, which is no monument that stands today: "
                "visitors can only point at what is there."
            )
        if landmark.id in {other.id for other in landmarks[:i]}:
            raise SiteError(f"{file}: 'landmark[{i}].id' is {landmark.id!r}, which an earlier landmark has already.")


def _outline(file: Path, monument: Monument) -> Polygon:
    outline = Polygon(monument.footprint.corners_en_m)
    key = f"{file}: '{monument.id}.footprint.value'"
    if not outline.is_valid:
        raise SiteError(f"{key} is no outline: {explain_validity(outline)}.")
    if not outline.exterior.is_ccw:
        raise SiteError(f"{key} runs clockwise; list the corners counter-clockwise from the south-west one.")
    return outline


def _bearers(monument: Monument, by_id: dict[str, Monument]) -> set[str]:
    """Ids of all that carry a monument, one on another."""
    found: set[str] = set()
    bearer = monument.stands_on
    while bearer is not None and bearer not in found:
        found.add(bearer)
        bearer = by_id[bearer].stands_on
    return found
