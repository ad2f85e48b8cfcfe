"""What one address may ask: buckets, places, and who counts as one address."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.limits import Bucket, Limits, Places, Visitors, network_of


@given(st.lists(st.floats(0.0, 10.0), max_size=200))
def test_a_bucket_gives_no_more_than_its_rate_and_size(pauses_s: list[float]) -> None:
    bucket, now_s, taken = Bucket(2.0, 5.0, 0.0), 0.0, 0
    for pause_s in pauses_s:
        now_s += pause_s
        taken += bucket.take(now_s)
        assert taken <= 5.0 + 2.0 * now_s + 1e-6


def test_a_bucket_fills_again_and_not_beyond_its_size() -> None:
    bucket = Bucket(1.0, 2.0, 0.0)
    assert [bucket.take(0.0) for _ in range(3)] == [True, True, False]
    assert [bucket.take(1.0) for _ in range(2)] == [True, False]
    assert [bucket.take(1000.0) for _ in range(3)] == [True, True, False]


def test_a_place_that_is_left_is_free() -> None:
    places = Places(1)
    assert places.enter("192.0.2.1")
    assert not places.enter("192.0.2.1")
    assert places.enter("192.0.2.2")
    places.leave("192.0.2.1")
    assert places.enter("192.0.2.1")


@pytest.mark.parametrize(
    ("address", "network"),
    [
        ("192.0.2.1", "192.0.2.1"),
        ("::ffff:192.0.2.1", "192.0.2.1"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::"),
        ("2001:db8:1:2::9", "2001:db8:1:2::"),
        ("testclient", "testclient"),
    ],
)
def test_a_subscriber_is_one_address(address: str, network: str) -> None:
    assert network_of(address) == network


def test_one_address_does_not_use_up_anothers_share_and_many_fill_no_memory() -> None:
    visitors = Visitors(Limits(requests_per_s=0.001, burst=2), lambda: 0.0)
    assert [visitors.may_ask("192.0.2.1") for _ in range(3)] == [True, True, False]
    assert visitors.may_ask("192.0.2.2")
    for i in range(10_000):
        visitors.may_ask(f"10.0.{i // 256}.{i % 256}")
    assert visitors.may_ask("192.0.2.1"), "whoever was silent longest is forgotten"


def test_a_proxys_connections_are_everybodys() -> None:
    visitors = Visitors(Limits(connections=1), lambda: 0.0)
    assert all(visitors.admit("127.0.0.1") for _ in range(5))
    assert [visitors.admit("192.0.2.1") for _ in range(2)] == [True, False]
