"""The square as the console draws it."""

import numpy as np
import pytest

from assets.site import load_site
from server.console.model import Part, build_parts
from server.options import SITE


@pytest.fixture(scope="module")
def parts() -> list[Part]:
    return build_parts(load_site(SITE))


def test_it_is_few_meshes_that_can_be_tinted_and_sent(parts: list[Part]) -> None:
    assert len({part.name for part in parts}) == len(parts) < 60
    assert {part.evidence for part in parts} == {"attested", "inferred", "hypothetical"}
    assert {part.layer for part in parts} == {"buildings", "land"}
    assert sum(part.positions_m.nbytes + part.triangles.nbytes for part in parts) < 8e6
    for part in parts:
        assert part.triangles.max() < len(part.positions_m)
        assert max(part.colour) < 256


def test_roofs_are_redder_than_marble_and_leaves_greener(parts: list[Part]) -> None:
    colours = {part.name.partition("/")[2].rpartition("-")[0]: part.colour for part in parts}
    assert colours["tiles"][0] > 1.3 * colours["tiles"][2]
    assert max(np.abs(np.diff(colours["marble"]))) < 20
    assert colours["leaves"][1] > colours["leaves"][2]


def test_of_rivals_one_is_drawn(parts: list[Part]) -> None:
    """The temple stands, and so its ruin does not lie between its columns: drums lie at man's height in the cella."""
    inside = [
        np.abs(part.positions_m - (-64.0, -11.5, 2.2)).max(axis=1) < (1.2)
        for part in parts
        if part.layer == "buildings"
    ]
    assert not any(found.any() for found in inside)
