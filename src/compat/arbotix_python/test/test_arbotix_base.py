"""The simulated base's arithmetic and its parameters; needs no master."""

import math

import pytest
from arbotix_python.base import Base, BaseSettings, SettingsError, read_settings

TUTORIAL = {"type": "diff_controller", "base_frame_id": "base_footprint", "base_width": 0.2,
            "ticks_meter": 2000, "Kp": 12, "Kd": 12, "Ki": 0, "Ko": 50, "accel_limit": 1.0}


def driven(base, speed, turn, seconds, step=0.1):
    for tick in range(round(seconds / step)):
        base.command(speed, turn, tick * step)
        base.advance((tick + 1) * step, step)
    return base


def test_straight_on():
    base = driven(Base(BaseSettings()), 0.2, 0.0, 5.0)
    assert (base.x, base.y, base.yaw) == pytest.approx((1.0, 0.0, 0.0))


def test_a_circle_closes():
    base = driven(Base(BaseSettings()), 0.2, 0.5, 2 * math.pi / 0.5, step=2 * math.pi / 50)
    assert (base.x, base.y, base.yaw) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_half_a_circle_is_its_diameter_wide():
    base = driven(Base(BaseSettings()), 0.2, 0.5, 2 * math.pi, step=2 * math.pi / 10)
    assert (base.x, base.y) == pytest.approx((0.0, 2 * 0.2 / 0.5), abs=1e-9)


def test_the_last_command_stands_unless_there_is_a_timeout():
    lasting, forgetting = Base(BaseSettings()), Base(BaseSettings(timeout=1.0))
    for base in (lasting, forgetting):
        base.command(0.2, 0.5, 0.0)
        for tick in range(1, 31):
            base.advance(tick * 0.1, 0.1)
    assert (lasting.speed, lasting.turn) == (0.2, 0.5)
    assert (forgetting.speed, forgetting.turn) == (0.0, 0.0)


def test_wheels_turn_where_their_radius_is_known():
    base = driven(Base(BaseSettings(base_width=0.2, wheel_radius=0.05)), 0.2, 0.5, 2.0)
    assert base.wheel_angles == pytest.approx([(0.2 - 0.05) / 0.05 * 2, (0.2 + 0.05) / 0.05 * 2])
    assert driven(Base(BaseSettings(base_width=0.2)), 0.2, 0.5, 2.0).wheel_angles == [0.0, 0.0]


def test_the_tutorials_parameters():
    settings = read_settings("base_controller", TUTORIAL)
    assert settings == BaseSettings(base_frame_id="base_footprint", base_width=0.2)


@pytest.mark.parametrize("change, said", [
    ({"type": "follow_controller"}, "only diff_controller is simulated"),
    ({"base_width": "wide"}, "base_width is wide: it must be a number above 0"),
    ({"rate": 0}, "rate is 0: it must be a number above 0"),
    ({"joint_names": ["left"]}, "it must be a list of two"),
])
def test_what_cannot_be_is_named(change, said):
    with pytest.raises(SettingsError, match=said):
        read_settings("base_controller", {**TUTORIAL, **change})


def test_a_controller_that_is_no_table_is_named():
    with pytest.raises(SettingsError, match="controller base is 'diff': it must be a table"):
        read_settings("base", "diff")


def test_what_is_missing_is_named():
    with pytest.raises(SettingsError, match="base_controller has no base_width and no ticks_meter"):
        read_settings("base_controller", {"type": "diff_controller"})
