"""Monuments as JSON: plain values, in the order of the file."""

import json

from assets.facts import list_monuments, monument_facts
from assets.site import Site


def test_every_monument_is_listed_in_the_order_of_the_file(site: Site) -> None:
    listed = list_monuments(site)
    assert [facts["id"] for facts in listed] == [monument.id for monument in site.monuments]
    assert json.loads(json.dumps(listed)) == listed


def test_facts_are_the_monuments(site: Site) -> None:
    facts = monument_facts(site.monument("prytaneion"))
    assert facts["names"] == {"en": "Prytaneion", "tr": "Prytaneion"}
    assert (facts["height_m"], facts["base_z_m"], facts["evidence"]) == (11.6, 1.2, "attested")
    assert facts["source"] == "FiE9/4, EHW"
    assert len(facts["footprint_en"]) == 4
