"""What single monuments must show: seats and stairs, a view through the doors, statues, two storeys of little columns."""

import numpy as np
import pytest

from assets.building import Building
from assets.monuments import bouleuterion, court, fountain, hall
from assets.monuments.bouleuterion import LOWER, SCENE_M, UPPER, rows_profile
from assets.shape import size_m
from assets.site import Site
from tests.assets.geometry import drawn


def test_a_block_of_seats_rises_row_by_row() -> None:
    for nosing in (False, True):
        profile = rows_profile(LOWER, nosing)
        assert list(profile[-1]) == pytest.approx([LOWER[0] + LOWER[2] * LOWER[3], LOWER[2] * LOWER[4]])
        heights = [z for _, z in profile]
        assert heights == sorted(heights)


def test_the_council_house_seats_about_1400(site: Site) -> None:
    building = Building(site.monument("bouleuterion"))
    bouleuterion.bouleuterion(building)
    seat_m, metres = 0.55, 0.0
    for radius, _, rows, depth, _ in (LOWER, UPPER):
        metres += sum(np.pi * (radius + depth * (i + 0.5)) for i in range(rows))
    stairs = sum(0.72 * n * block[2] for block, n in ((LOWER, 6), (UPPER, 11)))
    assert 1200 < (metres - stairs) / seat_m < 2000
    shape = building.elements["seats"].shape
    points = drawn(shape).reshape(-1, 3)
    reach = np.hypot(points[:, 0] - size_m(building.monument)[0] / 2.0, points[:, 1] - SCENE_M)
    assert reach.max() < 22.0
    assert points[:, 2].max() == pytest.approx(UPPER[1] + UPPER[2] * UPPER[4])


def test_one_sees_through_the_doors_to_the_seats(site: Site) -> None:
    building = Building(site.monument("bouleuterion"))
    bouleuterion.bouleuterion(building)
    middle = size_m(building.monument)[0] / 2.0
    for name in ("", "stage_wall"):
        triangles = drawn(building.elements[name].shape)
        across = triangles[
            (triangles[..., 0].min(axis=1) < middle - 0.05)
            & (triangles[..., 0].max(axis=1) > middle + 0.05)
            & (triangles[..., 1].max(axis=1) < 3.3)
            & (triangles[..., 2].min(axis=1) < 3.0)
            & (triangles[..., 2].max(axis=1) > 3.0)
        ]
        assert len(across) == 0, name


def test_the_hydrekdocheion_has_two_storeys_of_columns(site: Site) -> None:
    building = Building(site.monument("hydrekdocheion"), level=2)
    fountain.nymphaeum(building)
    feet = sorted({round(float(T[2, 3]), 3) for _, many in building.elements["columns"].many for T in many})
    lower = building.measure("column_height_m")
    assert feet == [pytest.approx(1.2), pytest.approx(1.2 + lower + 0.55)]
    counts = [len(many) for _, many in building.elements["columns"].many]
    assert sum(counts) == 40


def test_the_eastern_portico_of_the_peristyle_is_the_higher_one(site: Site) -> None:
    building = Building(site.monument("rhodian_peristyle"), level=2)
    court.court(building)
    tops = {round(float(drawn(part)[..., 2].max()), 2) for part, _ in building.elements["columns"].many}
    low = building.measure("column_height_m")
    assert tops == {round(low, 2), round(1.24 * low, 2)}


def test_augustus_and_livia_sit_in_the_eastern_hall_alone(site: Site) -> None:
    for name in ("chalcidicum_e", "banquet_house"):
        building = Building(site.monument(name), level=2)
        hall.hall(building)
        seated = building.elements.get("statues")
        assert (sum(len(many) for _, many in seated.many) if seated else 0) == (2 if name == "chalcidicum_e" else 0)
