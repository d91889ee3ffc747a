"""The simulator node's command line, without a master."""

from pathlib import Path

import pytest

from bullet_sim_ros.node import open_world, parse
from bullet_sim_ros.package_paths import open_resources

WORLD = str(Path(__file__).with_name("camera_robot.world"))


def opened(*words):
    world = open_world(parse(["--world", WORLD, *words]), open_resources())
    world.close()
    return world


@pytest.mark.parametrize("words, rate_hz", [
    ((), 1000.0), (("--real-time-factor", "0"), 0.0), (("--real-time-factor=2",), 2000.0),
    (("--real-time-factor", "0.5"), 500.0)])
def test_real_time_factor_becomes_the_update_rate(words, rate_hz):
    # conforms: gzserver/--real_time_factor, empty_world.launch/real_time_factor
    assert opened(*words).description.physics.real_time_update_rate == pytest.approx(rate_hz)


@pytest.mark.parametrize("words", [(), ("--real-time-factor=1",)])
def test_a_step_of_nothing_is_an_error_line_with_and_without_a_factor(tmp_path, caplog, words):
    path = tmp_path / "step.world"
    path.write_text("<sdf version='1.6'><world name='w'><physics type='ode'>"
                    "<max_step_size>0</max_step_size></physics></world></sdf>")
    world = open_world(parse(["--world", str(path), *words]), open_resources())
    assert world.timestep == 0.001
    assert [record.getMessage() for record in caplog.records] == [
        "<physics>: a time step of 0 s is not possible; 1e-05 to 0.1 is; 0.001 is used instead"]


def test_seed_and_pause():
    # conforms: gzserver/--seed, gzserver/-u, empty_world.launch/seed
    assert (opened().seed, opened().paused) == (0, False)
    world = opened("--seed", "12345678901", "--paused")
    assert (world.seed, world.paused) == (12345678901, True)


@pytest.mark.parametrize("option, value, said", [
    *(("--real-time-factor", value, "is not a number, 0 to")
      for value in ("fast", "-1", "nan", "inf", "")),
    *(("--seed", value, "is not a whole number, 0 or more") for value in ("-1", "1.5", "x", ""))])
def test_a_value_that_makes_no_sense_is_named(capsys, option, value, said):
    with pytest.raises(SystemExit) as ended:
        parse([f"{option}={value}"])
    assert ended.value.code == 2
    assert f"{value!r} {said}" in capsys.readouterr().err
