"""The simulated world: the same by its seed, as wrong as it says it is, and one thing different in each scenario."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.benchmarks.accuracy import inertial_unit, magnetometer, receiver
from tests.benchmarks.accuracy.alignment import SIGMA_RAD, point_out
from tests.benchmarks.accuracy.scenarios import (
    DISTURBED_FROM_S,
    DURATION_S,
    LOOK_FROM_S,
    SCENARIOS,
    SPELL_S,
    STILL_S,
    TURNED_S,
    Scenario,
)
from tests.benchmarks.accuracy.terrain import EYE_HEIGHT_M, Hills, hills_m
from tests.benchmarks.accuracy.visitor import Visitor, head_rig, visitor
from tests.benchmarks.accuracy.world import WALKING_M_S, Recording, record
from tracker.choreography import AGORA_TOUR
from tracker.geodesy import SiteFrame, gravity_m_s2
from tracker.geomagnetism import magnetic_field
from tracker.measurements import GpsFix, GpsVelocity, ImuSample, MagSample, Sighting, Standpoint, TruePose
from tracker.simulate import AGORA_ORIGIN, START_NS, flat_ground

PLAIN, UNDERSTATED = SCENARIOS["plain"], SCENARIOS["understated"]
SHORT_S = 40.0


@pytest.fixture(scope="module")
def plain() -> Recording:
    """Forty seconds of an ordinary visit."""
    return record(PLAIN, 1, duration_s=SHORT_S)


def of(recording: Recording, kind: type) -> list[object]:
    """Return one kind of measurement."""
    return [m for m in recording.measurements if isinstance(m, kind)]


def walk_of(seed: int, duration_s: float = 180.0) -> Visitor:
    """Return a walk without sensors."""
    return visitor(seed, duration_s, AGORA_TOUR, AGORA_ORIGIN, Hills(flat_ground).ground_z_m)


def test_a_seed_gives_the_same_numbers_and_another_gives_others(plain: Recording) -> None:
    again, other = (record(PLAIN, seed, duration_s=SHORT_S).measurements for seed in (1, 2))
    assert again == plain.measurements
    for kind in (ImuSample, MagSample, GpsFix, TruePose):
        assert [m for m in other if isinstance(m, kind)] != of(plain, kind)


def test_measurements_come_in_order_and_none_before_it_was_made(plain: Recording) -> None:
    arrivals = [m.t_recv_ns for m in plain.measurements]
    assert arrivals == sorted(arrivals)
    assert all(m.t_recv_ns >= m.t_ns for m in plain.measurements)
    late_s = [(m.t_recv_ns - m.t_ns) * 1e-9 for m in plain.measurements if isinstance(m, GpsFix)]
    assert 0.15 <= min(late_s) < 0.2
    assert 0.3 < max(late_s) <= 0.35


def test_velocity_acceleration_and_rate_are_those_of_the_motion() -> None:
    """By central differences, over standing, walking and the look to both sides."""
    walk, half_ns = walk_of(3), 100_000
    t_ns = START_NS + np.arange(round(0.3e9), round(175e9), 377_000_000)
    before, now, after = (walk.at(t_ns + offset) for offset in (-half_ns, 0, half_ns))
    step_s = 2e-9 * half_ns
    assert np.allclose((after.p_m - before.p_m) / step_s, now.v_m_s, atol=1e-6)
    assert np.allclose((after.v_m_s - before.v_m_s) / step_s, now.a_m_s2, atol=1e-4)
    turned = Rotation.from_matrix(np.einsum("nji,njk->nik", before.R_site_body, after.R_site_body)).as_rotvec()
    assert np.allclose(turned / step_s, now.omega_body_rad_s, atol=1e-5)


def test_a_standing_person_is_not_quite_still() -> None:
    """Millimetres and tenths of a degree, as heads do."""
    walk = walk_of(4, 30.0)
    motion = walk.at(walk.stamps(50.0)[: round(0.6 * STILL_S * 50)])
    assert np.all((motion.p_m.std(axis=0) > 0.0003) & (motion.p_m.std(axis=0) < 0.012))
    rate_deg_s = np.degrees(np.sqrt(np.mean(motion.omega_body_rad_s**2, axis=0)))
    assert np.all((rate_deg_s > 0.1) & (rate_deg_s < 3.0))


def test_the_ground_has_slopes_and_steps_and_eyes_are_above_it() -> None:
    at_step_m = hills_m(np.array([-39.99, -40.01, -40.41, -40.81]), np.full(4, -40.0))
    assert np.diff(at_step_m) == pytest.approx([0.17, 0.17, 0.17], abs=0.06)
    walk = walk_of(5)
    p = walk.at(walk.stamps(2.0)).p_m
    above_m = p[:, 2] - Hills(flat_ground).ground_z_m(p[:, 0], p[:, 1])
    assert np.ptp(p[:, 2]) > 0.5
    assert abs(np.median(above_m) - EYE_HEIGHT_M) < 0.15
    assert above_m.std() < 0.15


def test_a_receivers_error_has_the_size_it_claims() -> None:
    """Over many starts; a receiver that understates claims 1.5 times less."""
    errors = np.array([receiver.position_error_m(np.random.default_rng(n), 1)[0] for n in range(3000)])
    assert errors.std(axis=0) == pytest.approx(receiver.claimed_m(), rel=0.05)
    honest, bold = (next(receiver.receive(walk_of(1, 3.0), s.understates, None)) for s in (PLAIN, UNDERSTATED))
    assert isinstance(honest, GpsFix)
    assert isinstance(bold, GpsFix)
    assert honest.cov_enu_m2[::4] == pytest.approx(receiver.claimed_m() ** 2)
    assert np.array(honest.cov_enu_m2) == pytest.approx(1.5**2 * np.array(bold.cov_enu_m2))


def test_a_receivers_error_moves_on_two_time_scales() -> None:
    """Half the mean square of how far it moves in a time is what its parts say of that time."""
    error = receiver.position_error_m(np.random.default_rng(0), 60_000)[:, 0]
    for apart_s in (1, 20, 100):
        moved = np.mean((error[apart_s:] - error[:-apart_s]) ** 2) / 2.0
        parts = (
            size**2 * (1.0 - np.exp(-apart_s / time)) for time, size in zip((20.0, 400.0), (0.8, 1.6), strict=True)
        )
        assert moved == pytest.approx(0.3**2 + sum(parts), rel=0.08)


def test_a_receivers_velocity_is_now_and_then_half_a_metre_off() -> None:
    error = receiver.velocity_error_m_s(np.random.default_rng(0), 20_000)
    length = np.linalg.norm(error, axis=1)
    assert np.median(np.abs(error[:, 0])) / 0.6745 == pytest.approx(receiver.VELOCITY_M_S, rel=0.05)
    # beyond three deviations of the rest nearly all is spikes, most of them
    assert np.mean(length > 0.45) == pytest.approx(receiver.SPIKE_SHARE, rel=0.5)


def test_walls_set_fixes_and_velocities_aside_for_seconds_and_change_nothing_else() -> None:
    walk = walk_of(2)
    far, near = (
        {(type(m), m.t_ns): m for m in receiver.receive(walk, 1.0, None, walls=walls)} for walls in (False, True)
    )
    assert far.keys() == near.keys()
    differs = {
        kind: sorted(t for of, t in far if of is kind and far[of, t] != near[of, t]) for kind in (GpsFix, GpsVelocity)
    }
    assert differs[GpsFix] == differs[GpsVelocity]
    share = len(differs[GpsFix]) * 2 / len(far)
    assert 0.02 < share < 0.4


def test_a_spell_beside_a_wall_lasts_seconds_and_is_metres_aside() -> None:
    fixes, velocities = receiver.echoes(np.random.default_rng(1), 20_000)
    beside = np.asarray(fixes.any(axis=1))
    begun, over = np.flatnonzero(np.diff(beside.astype(int)) > 0), np.flatnonzero(np.diff(beside.astype(int)) < 0)
    spells_s = over[: len(begun)] - begun[: len(over)]
    assert spells_s.min() >= 2
    assert spells_s.max() <= 15
    assert np.array_equal(beside, velocities.any(axis=1))
    assert fixes[beside].std(axis=0) == pytest.approx(4.0 * receiver.AXES, rel=0.15)
    assert velocities[beside].std(axis=0) == pytest.approx([receiver.ECHO_M_S] * 3, rel=0.15)


def test_a_claim_that_wavers_changes_nothing_but_the_claim() -> None:
    walk = walk_of(2)
    usual, wavering = (list(receiver.receive(walk, 1.0, None, wavers=wavers)) for wavers in (False, True))
    assert [m for m in usual if isinstance(m, GpsVelocity)] == [m for m in wavering if isinstance(m, GpsVelocity)]
    pairs = [(a, b) for a, b in zip(usual, wavering, strict=True) if isinstance(a, GpsFix) and isinstance(b, GpsFix)]
    assert all(replace(b, cov_enu_m2=a.cov_enu_m2) == a for a, b in pairs)
    claims_m = np.sqrt([b.cov_enu_m2[0] for _, b in pairs])
    assert 0.15 < np.std(np.log(claims_m)) < 0.6


def test_a_claim_wavers_about_what_is_true_and_not_from_fix_to_fix() -> None:
    factors = np.log(receiver.wavering(np.random.default_rng(3), 50_000))
    assert np.median(factors) == pytest.approx(0.0, abs=0.05)
    assert np.median(np.abs(np.diff(factors))) < 0.5 * np.median(np.abs(factors))


def test_fixes_are_of_the_antenna(plain: Recording) -> None:
    """The mean of fix minus antenna over seeds is nearer to zero than the lever arm's height could hide."""
    site, walk = SiteFrame(AGORA_ORIGIN), plain.walk
    fixes = [m for m in plain.measurements if isinstance(m, GpsFix)]
    motion = walk.at(np.array([fix.t_ns for fix in fixes]))
    antenna_m = motion.p_m + motion.R_site_body @ head_rig().T_body_gps[:3, 3]
    rng = np.random.default_rng([1, receiver.STREAM])
    error_m = receiver.position_error_m(rng, len(fixes))
    measured_m = [site.site_from_geodetic(fix.lat_deg, fix.lon_deg, fix.h_ellipsoid_m) for fix in fixes]
    assert np.allclose(measured_m - antenna_m, error_m, atol=1e-6)


def test_an_inertial_unit_is_wrong_by_a_matrix_a_bias_and_white_noise(plain: Recording) -> None:
    """What is left of a sample once the best matrix and bias are taken off is as white noise of its size."""
    samples = [m for m in plain.measurements if isinstance(m, ImuSample)]
    motion = plain.walk.at(np.array([sample.t_ns for sample in samples]))
    gravity = np.array([0.0, 0.0, gravity_m_s2(AGORA_ORIGIN.lat_deg, AGORA_ORIGIN.h_ellipsoid_m)])
    force = np.einsum("nji,nj->ni", motion.R_site_body, motion.a_m_s2 + gravity)
    for true, measured, white in (
        (motion.omega_body_rad_s, [s.gyro_rad_s for s in samples], inertial_unit.GYRO_RAD_S),
        (force, [s.accel_m_s2 for s in samples], inertial_unit.ACCEL_M_S2),
    ):
        basis = np.column_stack([true, np.ones(len(true))])
        found, *_ = np.linalg.lstsq(basis, np.array(measured), rcond=None)
        left = np.array(measured) - basis @ found
        assert np.median(np.abs(left)) / 0.6745 == pytest.approx(white, rel=0.05)
        assert np.abs(found[:3] - np.eye(3)).max() < 0.03
        assert np.abs(found[:3] - np.eye(3)).max() > 0.0


def test_axes_lean_and_stretch_as_said() -> None:
    matrices = np.array([inertial_unit.axes(np.random.default_rng(n)) for n in range(1000)])
    assert matrices[:, [0, 1, 2], [0, 1, 2]].std() == pytest.approx(inertial_unit.SCALE, rel=0.1)
    lean = np.linalg.norm(matrices - matrices * np.eye(3), axis=2)
    assert np.sqrt(np.mean(lean**2)) == pytest.approx(inertial_unit.AXIS_RAD, rel=0.1)


def test_samples_come_in_pairs_and_a_few_are_lost() -> None:
    samples = [m for m in record(PLAIN, 1, duration_s=SHORT_S).measurements if isinstance(m, ImuSample)]
    sent = round(SHORT_S * inertial_unit.RATE_HZ)
    assert 0 < sent - len(samples) < 0.003 * sent
    arrivals = np.array([sample.t_recv_ns for sample in samples])
    assert np.mean(np.diff(arrivals) == 0) == pytest.approx(0.5, abs=0.01)


def test_a_gyroscope_feels_the_earth() -> None:
    """Two units alike but for the Earth differ by 15 degrees an hour."""
    walk = walk_of(1, 10.0)

    def mean_rad_s() -> NDArray[np.float64]:
        return np.asarray(np.mean([sample.gyro_rad_s for sample in inertial_unit.measure(walk)], axis=0))

    with pytest.MonkeyPatch.context() as patch:
        turning = mean_rad_s()
        patch.setattr(inertial_unit, "EARTH_RAD_S", 0.0)
        resting = mean_rad_s()
    assert np.degrees(np.linalg.norm(turning - resting)) * 3600.0 == pytest.approx(15.04, rel=0.03)


def test_a_magnetometer_is_off_by_iron_and_posts() -> None:
    """Its field in site is the Earth's within what iron does, and not the same everywhere."""
    walk = walk_of(2, 120.0)
    samples = list(magnetometer.sense(walk, "there", False))
    R = walk.at(np.array([sample.t_ns for sample in samples])).R_site_body
    field = np.einsum("nij,nj->ni", R, np.array([sample.field_body_t for sample in samples]))
    earth = magnetic_field(AGORA_ORIGIN.lat_deg, AGORA_ORIGIN.lon_deg, AGORA_ORIGIN.h_ellipsoid_m, START_NS).enu_t
    off = np.linalg.norm(field - np.array(earth), axis=1)
    assert 1e-6 < np.median(off) < 8e-6
    assert off.max() > 1.3 * np.median(off)


def difference_t(one: Scenario, other: Scenario, seed: int = 1) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return instants, and how far the magnetometers of two scenarios are apart, (n,)."""
    walk = walk_of(seed, DISTURBED_FROM_S + SPELL_S + 20.0)
    a, b = (list(magnetometer.sense(walk, s.magnetometer, s.disturbance)) for s in (one, other))
    t_s = np.array([(sample.t_ns - START_NS) * 1e-9 for sample in a])
    apart = np.array([p.field_body_t for p in a]) - np.array([p.field_body_t for p in b])
    return t_s, np.linalg.norm(apart, axis=1)


def test_a_disturbance_lasts_a_minute() -> None:
    t_s, apart_t = difference_t(PLAIN, SCENARIOS["disturbance"])
    inside = (t_s > DISTURBED_FROM_S + 3.0) & (t_s < DISTURBED_FROM_S + SPELL_S - 3.0)
    outside = (t_s < DISTURBED_FROM_S) | (t_s > DISTURBED_FROM_S + SPELL_S)
    assert apart_t[inside] == pytest.approx(magnetometer.DISTURBANCE_T, rel=0.1)
    assert np.all(apart_t[outside] == 0.0)


def test_a_magnetometer_that_is_turned_falls_silent() -> None:
    walk = walk_of(1, 30.0)
    right, wrong = (list(magnetometer.sense(walk, kind, False)) for kind in ("there", "turned"))
    assert wrong[-1].t_ns < START_NS + TURNED_S * 1e9
    assert list(magnetometer.sense(walk, "absent", False)) == []
    R = walk.at(np.array([sample.t_ns for sample in wrong])).R_site_body
    fields = [
        np.einsum("nij,nj->ni", R, np.array([sample.field_body_t for sample in samples[: len(wrong)]]))
        for samples in (right, wrong)
    ]
    yaw_rad = np.unwrap([np.arctan2(field[:, 1], field[:, 0]) for field in fields], axis=0)
    assert np.cos(yaw_rad[0] - yaw_rad[1]).max() < -0.8


def test_an_outage_is_a_minute_of_walking_without_a_receiver() -> None:
    outage = record(SCENARIOS["outage"], 1)
    assert outage.outage_s is not None
    begin_s, end_s = outage.outage_s
    assert end_s - begin_s == SPELL_S
    times_s = [(m.t_ns - START_NS) * 1e-9 for m in outage.measurements if isinstance(m, GpsFix | GpsVelocity)]
    assert not [t for t in times_s if begin_s <= t < end_s]
    assert len(times_s) == 2 * (DURATION_S - SPELL_S)
    v = outage.walk.at(START_NS + (np.arange(begin_s, end_s, 0.1) * 1e9).astype(np.int64)).v_m_s
    assert np.mean(np.hypot(v[:, 0], v[:, 1]) > WALKING_M_S) > 0.6
    with pytest.raises(ValueError, match="expected a walk of at least 180 s"):
        record(SCENARIOS["outage"], 1, duration_s=60.0)


def test_scenarios_share_all_that_they_do_not_change() -> None:
    """Paired: the same faults on the same walk."""
    recordings = [record(SCENARIOS[name], 1, duration_s=30.0) for name in ("plain", "no-magnetometer", "understated")]
    plain = recordings[0]
    for other in recordings[1:]:
        assert of(other, ImuSample) == of(plain, ImuSample)
        assert of(other, TruePose) == of(plain, TruePose)
        unclaimed = [[replace(fix, cov_enu_m2=()) for fix in of(r, GpsFix)] for r in (plain, other)]  # type: ignore[type-var]
        assert unclaimed[0] == unclaimed[1]


def rays(seed: int) -> tuple[list[float], list[float], float]:
    """Return the distances of a walk's landmarks, by how much each was pointed out wrongly, and their spread, radians."""
    walk = walk_of(seed)
    taps = [m for m in point_out(walk, 3, stands_here=False) if isinstance(m, Sighting)]
    T_site_cam = [walk.T_site_cam(tap.t_ns) for tap in taps]
    to = [np.array(tap.point_site_m) - T[:3, 3] for tap, T in zip(taps, T_site_cam, strict=True)]
    seen = [T[:3, :3] @ np.array(tap.ray_cam) for tap, T in zip(taps, T_site_cam, strict=True)]
    lengths = [float(np.linalg.norm(v)) for v in to]
    off = [float(np.arccos(min(1.0, v @ s / n))) for v, s, n in zip(to, seen, lengths, strict=True)]
    bearings = np.unwrap([np.arctan2(v[1], v[0]) for v in to])
    return lengths, off, float(np.ptp(bearings))


def test_landmarks_are_all_about_and_pointed_out_half_a_degree_wrong() -> None:
    lengths, off, spreads = zip(*(rays(seed) for seed in range(1, 13)), strict=True)
    assert all(len(one) == 3 and min(one) >= 20.0 and max(one) <= 40.0 for one in lengths)
    assert min(spreads) >= np.pi / 2
    # two directions across a ray
    assert np.sqrt(np.mean(np.square(off))) == pytest.approx(np.sqrt(2.0) * SIGMA_RAD, rel=0.25)


def test_who_stands_on_a_point_is_within_what_he_claims() -> None:
    walk = walk_of(1)
    here, tap = point_out(walk, 1, stands_here=True)
    assert isinstance(here, Standpoint)
    assert isinstance(tap, Sighting)
    assert here.t_ns == tap.t_ns >= START_NS + LOOK_FROM_S * 1e9
    true_m = walk.at(np.array([here.t_ns])).p_m[0]
    assert 0.0 < np.linalg.norm(true_m - here.p_site_m) < 4.0 * here.sigma_m


def test_the_ground_is_told_only_where_it_is_known(plain: Recording) -> None:
    assert plain.eyes_z_m is None
    told = record(SCENARIOS["ground"], 1, duration_s=SHORT_S)
    assert told.eyes_z_m is not None
    p = told.walk.at(told.walk.stamps(1.0)).p_m
    off_m = [told.eyes_z_m(e, n) - z for e, n, z in p.tolist()]
    assert 0.0 < np.sqrt(np.mean(np.square(off_m))) < 0.25
