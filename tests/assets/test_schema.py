"""Evidence on every element: each node of both models tells how it is known, and from where."""

from typing import get_args

import pytest

from assets.gltf import Scene
from assets.site import Evidence, Site

ROLES = {"ground", "building", "plant", "backdrop"}


@pytest.mark.parametrize("model", ["roman", "today"])
def test_every_element_has_evidence_and_source(site: Site, model: str, request: pytest.FixtureRequest) -> None:
    scene: Scene = request.getfixturevalue(model)
    monuments = {m.id for m in site.monuments}
    for node in scene.nodes:
        assert node.extras["role"] in ROLES, node.name
        if node.name.partition("/")[0] not in monuments:
            continue
        assert node.extras["evidence"] in get_args(Evidence), node.name
        assert set(node.extras["source"].split(", ")) <= set(site.sources), node.name
        assert node.extras["monument"] == node.name.partition("/")[0]


def test_variants_of_nodes_are_those_of_the_data(site: Site, roman: Scene) -> None:
    drawn = {(n.extras["monument"], n.extras["variant"]) for n in roman.nodes if "variant" in n.extras}
    assert drawn == {(m.id, v.id) for m in site.shown_in("roman") for v in m.variants}


def test_a_guess_is_not_told_as_a_find(roman: Scene) -> None:
    roofs = {node.extras["evidence"] for node in roman.nodes if node.name.endswith("/roof")}
    assert roofs == {"hypothetical"}
