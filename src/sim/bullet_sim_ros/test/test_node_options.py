"""The simulator node's command line, without a master."""

import logging
from pathlib import Path

import pytest
import rosgraph

from bullet_sim_ros import node
from bullet_sim_ros.node import open_world, parse
from bullet_sim_ros.package_paths import open_resources
from bullet_sim_ros.params import NodeParameters

WORLD = str(Path(__file__).with_name("camera_robot.world"))


def opened(*words):
    world = open_world(parse(["--world", WORLD, *words]), open_resources())
    world.close()
    return world


@pytest.mark.parametrize("words, rate_hz", [
    ((), 1000.0), (("--real-time-factor", "0"), 0.0), (("--real-time-factor=2",), 2000.0),
    (("--real-time-factor", "0.5"), 500.0)])
def test_real_time_factor_becomes_the_update_rate(words, rate_hz):
    # conforms: gzserver/--real_time_factor
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
    # conforms: gzserver/--seed, gzserver/-u
    assert (opened().seed, opened().paused) == (0, False)
    world = opened("--seed", "12345678901", "--paused")
    assert (world.seed, world.paused) == (12345678901, True)


def test_time_begins_where_it_is_told():
    # conforms: gzserver/--initial_sim_time
    assert (opened().time, opened("--initial-sim-time", "2.5").time) == (0.0, 2.5)


@pytest.mark.parametrize("option, value, said", [
    *(("--real-time-factor", value, "is not a number, 0 to")
      for value in ("fast", "-1", "nan", "inf", "")),
    *(("--seed", value, "is not a whole number, 0 or more") for value in ("-1", "1.5", "x", ""))])
def test_a_value_that_makes_no_sense_is_named(capsys, option, value, said):
    with pytest.raises(SystemExit) as ended:
        parse([f"{option}={value}"])
    assert ended.value.code == 2
    assert f"{value!r} {said}" in capsys.readouterr().err


@pytest.mark.parametrize("lost", ["read_node_parameters", "open_network"])
def test_a_master_that_ends_meanwhile_is_one_line(monkeypatch, capsys, caplog, lost):
    """Chaos: race, seed 106, restarts the master while the simulator starts."""
    def lose(*_):
        raise ConnectionRefusedError(111, "Connection refused")

    for name in ("wait_for_master", "send_promptly", "keep_every_publisher", "check_engine",
                 "forward_core_log", "register_plugins"):
        monkeypatch.setattr(node, name, lambda *_: None)
    monkeypatch.setattr(node, "read_node_parameters", NodeParameters)
    monkeypatch.setattr(node, lost, lose)
    monkeypatch.setattr(node, "register", lambda _world: True)
    monkeypatch.setattr("sys.argv", ["gzserver", "--world", WORLD])
    monkeypatch.setattr("sys.setswitchinterval", lambda _: None)
    monkeypatch.setattr(node, "end_by_signals", lambda *_: None)
    assert node.main() == 1
    told = [record for record in caplog.records if record.levelno == logging.CRITICAL]
    assert len(told) == 1 and "has ended while the simulator started" in told[0].getMessage()
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("engine, said", [
    ("ode", ""), ("simbody", ""), ("newton", "There is no physics engine 'newton'; there are ode")])
def test_an_engine_that_gazebo_does_not_know_is_an_error_line(caplog, engine, said):
    # conforms: gzserver/-e
    node.check_engine(engine)
    assert [record.levelno for record in caplog.records] == ([logging.ERROR] if said else [])
    assert said in caplog.text


def test_without_a_ros_network_it_says_so(caplog):
    # conforms: ~enable_ros_network
    with caplog.at_level(logging.INFO):
        node.open_network(None, NodeParameters(enable_ros_network=False))
    assert "ROS gazebo topics/services are disabled" in caplog.text


@pytest.mark.parametrize("verbose, told", [(True, ["loading"]), (False, [])])
def test_a_verbose_simulator_also_says_what_it_loads(monkeypatch, verbose, told):
    # conforms: gzserver/--verbose
    core, said = logging.getLogger("bullet_sim"), []
    monkeypatch.setattr(core, "handlers", [])
    monkeypatch.setattr(core, "propagate", True)
    monkeypatch.setattr(logging.getLogger("rosout"), "log", lambda _level, _form, text:
                        said.append(text))
    before = core.level
    try:
        node.forward_core_log(verbose)
        logging.getLogger("bullet_sim.formats").info("loading")
    finally:
        core.setLevel(before)
    assert said == told


def test_a_world_that_is_not_there_is_a_fatal_line_and_the_exit_code(monkeypatch, caplog):
    # conforms: gzserver/WORLD, gzserver/--verbose, gzserver/-e
    monkeypatch.setattr("sys.argv", ["gzserver", "--world", "worlds/nowhere.world", "--verbose",
                                     "--physics", "newton"])
    verbose = []
    monkeypatch.setattr(rosgraph, "is_master_online", lambda: True)
    monkeypatch.setattr(node, "wait_for_master", lambda *_: None)
    monkeypatch.setattr(node, "register", lambda _world: True)
    monkeypatch.setattr(node, "send_promptly", lambda: None)
    monkeypatch.setattr(node, "keep_every_publisher", lambda: None)
    monkeypatch.setattr(node, "forward_core_log", verbose.append)
    monkeypatch.setattr("sys.setswitchinterval", lambda _seconds: None)
    assert node.main() == 1
    engine, record = caplog.records
    assert verbose == [True] and "no physics engine 'newton'" in engine.getMessage()
    assert record.levelno == logging.CRITICAL
    assert record.getMessage().startswith("worlds/nowhere.world not found (searched: ")
