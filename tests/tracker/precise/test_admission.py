"""Stamps that leap and fixes that nobody can have walked to are left out, until they insist."""

from collections.abc import Iterable

from tracker.geodesy import SiteFrame
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, Standpoint
from tracker.precise.admission import Admission
from tracker.simulate import AGORA_ORIGIN

S = 1_000_000_000
ZERO = (0.0, 0.0, 0.0)
SITE = SiteFrame(AGORA_ORIGIN)


def _fix(t_s: float, east_m: float) -> GpsFix:
    lat, lon, h = SITE.geodetic_from_site((east_m, 0.0, 0.0))
    return GpsFix(round(t_s * S), round(t_s * S), lat, lon, h, (0.0,) * 9)


def _let_in(admission: Admission, fixes: Iterable[GpsFix]) -> list[bool]:
    return [not admission.refuses(fix, fix.t_ns) for fix in fixes]


def _imu(t_ns: int) -> ImuSample:
    return ImuSample(t_ns, t_ns, ZERO, ZERO)


def test_one_fix_far_away_is_left_out() -> None:
    assert _let_in(Admission(SITE), [_fix(0, 0.0), _fix(1, 5000.0), _fix(2, 2.0)]) == [True, False, True]


def test_fixes_that_stay_far_away_are_believed() -> None:
    fixes = [_fix(0, 0.0), *(_fix(t, 5000.0 + t) for t in range(1, 7))]
    assert _let_in(Admission(SITE), fixes) == [True, False, False, False, False, True, True]


def test_fixes_far_from_each_other_are_not_nor_is_one_that_is_repeated() -> None:
    scattered = [_fix(0, 0.0), *(_fix(t, 5000.0 * t) for t in range(1, 20))]
    assert _let_in(Admission(SITE), scattered)[1:] == [False] * 19
    assert _let_in(Admission(SITE), [_fix(0, 0.0), *[_fix(1, 5000.0)] * 20])[1:] == [False] * 20


def test_a_good_fix_between_them_ends_their_case() -> None:
    fixes = [_fix(t, 0.0 if t % 4 == 0 else 5000.0) for t in range(20)]
    assert _let_in(Admission(SITE), fixes) == [t % 4 == 0 for t in range(20)]


def test_after_a_long_silence_one_may_be_elsewhere() -> None:
    assert _let_in(Admission(SITE), [_fix(0, 0.0), _fix(60, 2000.0)]) == [True, True]


def test_a_sample_that_leaps_is_left_out_and_ten_that_follow_each_other_are_not() -> None:
    admission, leap_ns = Admission(SITE), 3600 * S
    assert not admission.refuses(_imu(S), S)
    assert admission.refuses(_imu(leap_ns), S)
    assert not admission.refuses(_imu(2 * S), S), "a second without samples is none"
    later = [admission.refuses(_imu(leap_ns + index * S // 100), S) for index in range(12)]
    assert later == [True] * 9 + [False] * 3
    scattered = Admission(SITE)
    assert all(scattered.refuses(_imu(leap_ns * (index + 1)), S) for index in range(50))
    assert all(scattered.refuses(_imu(leap_ns), S) for _ in range(50))


def test_what_is_stamped_far_ahead_of_the_inertial_sensor_is_left_out() -> None:
    admission = Admission(SITE)
    assert not admission.refuses(GpsVelocity(2 * S, 2 * S, ZERO), S)
    assert admission.refuses(GpsVelocity(7 * S, 7 * S, ZERO), S)


def test_nobody_stands_a_kilometre_from_where_the_receiver_has_them() -> None:
    admission, near, far = Admission(SITE), (900.0, 0.0, 0.0), (1100.0, 0.0, 0.0)
    assert not admission.refuses(Standpoint(0, 0, far, 1.0), 0), "nothing is known yet"
    _let_in(admission, [_fix(0, 0.0)])
    assert not admission.refuses(Standpoint(S, S, near, 1.0), S)
    assert admission.refuses(Standpoint(S, S, far, 1.0), S)
