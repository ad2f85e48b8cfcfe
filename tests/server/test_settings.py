"""Settings by name: every one can be named and chosen, and what cannot be is refused in one sentence."""

import pytest

from server.settings import all_settings, choose
from tracker.errors import InputError
from tracker.estimators import Settings


def test_every_setting_is_explained_and_its_default_changes_nothing() -> None:
    settings = all_settings()
    assert all(setting.meaning for setting in settings), [s.key for s in settings if not s.meaning]
    assert len({setting.key for setting in settings}) == len(settings)
    chosen = choose(f"{setting.key}={setting.text}" for setting in settings)
    assert chosen.paper.sensors.gps_var_m2 == pytest.approx(Settings().paper.sensors.gps_var_m2, rel=1e-5)
    assert choose(f"{s.key}={s.text}" for s in settings if "gps_var" not in s.key) == Settings()


def test_the_readings_of_the_paper_can_be_chosen_by_the_end_of_their_names() -> None:
    paper = choose(["m_P=literal_ecef", "m_imu=literal", "innovation=nis", "sensors.camera_north=false"]).paper
    assert (paper.sensors.m_P, paper.sensors.m_imu, paper.innovation) == ("literal_ecef", "literal", "nis")
    assert not paper.sensors.camera_north
    assert choose(["fuzzy.position_m=[1, 2, 3]"]).paper.fuzzy.position_m == (1.0, 2.0, 3.0)
    assert choose(["gps_var_m2=[1, 2, 3]"]).paper.sensors.gps_var_m2 == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        ("m_P", "has no value"),
        ("m_P=upside_down", "m_P cannot be 'upside_down'.*keyframe_local"),
        ("camera=1", "no setting 'camera'.*agora settings"),
        ("=1", "no setting ''"),
        ("cycle_s=soon", "cycle_s cannot be 'soon'"),
        ("cycle_s=0", "cycle_s must be a number above zero"),
        ("cycle_s=NaN", "cycle_s must be a number above zero"),
        ("gps_var_m2=[1, 2]", "gps_var_m2 cannot be"),
        ("accel_noise_m_s2=-1", "accel_noise_m_s2 must be"),
        ("cycle_s.x=1", "no setting"),
        ("fuzzy.position_m=[3, 2, 1]", "expected 0 <= low < medium < high"),
        ("mean_samples=0", "mean_samples must be"),
        ("lag_s=-1", "lag_s must be a number above zero"),
        ("gps_error_share=[0.5, 0.5, 0.5]", "more than the whole: 1.5"),
    ],
)
def test_what_cannot_be_chosen_is_named(pair: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        choose([pair])
