"""The state log: what a judge believes instead of topics."""

import json
from pathlib import Path

import pytest
from gazebo_msgs.msg import ModelState

from bullet_sim.pose import Pose
from bullet_sim.rendering.scene_text import scene_from_text
from bullet_sim_ros.recording import Recording
from bullet_sim_ros.state_log import StateLog

BOX = """<model name="NAME"><link name="body">
  <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
</link></model>"""


@pytest.fixture
def logged(bench, tmp_path):
    """A bench, and the lines of its state log."""
    StateLog(bench.simulation, tmp_path / "state.jsonl")
    bench.spawn(BOX.replace("NAME", "low"), Pose((0, 0, 0.5)))
    bench.spawn(BOX.replace("NAME", "high"), Pose((0, 0, 5)))
    return bench, lambda: [json.loads(line)
                           for line in (tmp_path / "state.jsonl").read_text().splitlines()]


def test_poses_and_contacts_of_what_moves_at_25_hz(logged):
    bench, lines = logged
    bench.run(0.4)
    states = lines()
    assert [state["time"] for state in states[:3]] == pytest.approx([0.04, 0.08, 0.12])
    assert len(states) == 10
    assert set(states[-1]["poses"]) == {"low", "high"}  # and not the ground
    assert states[0]["poses"]["low"] == pytest.approx([0, 0, 0.5, 0, 0, 0, 1], abs=1e-3)
    assert states[-1]["contacts"] == [["ground_plane", "low"]]
    assert states[-1]["unanswered"] == 0


def test_who_acts_on_the_world_by_service_or_topic(logged):
    bench, lines = logged
    bench.call("/gazebo/get_model_state", model_name="low")
    bench.call("/gazebo/pause_physics")
    bench.call("/gazebo/unpause_physics")
    bench.send("/gazebo/set_model_state", ModelState(model_name="low"))
    bench.run(0.01)
    assert [line["call"] for line in lines() if "call" in line] == [
        "/gazebo/get_model_state", "/gazebo/pause_physics", "/gazebo/unpause_physics",
        "/gazebo/set_model_state"]


def test_a_plugin_s_service_is_a_call_too(logged):
    bench, lines = logged
    bench.spawn("""<model name="cart"><link name="base"/><plugin name="p"
      filename="libgazebo_ros_imu.so"><bodyName>base</bodyName><topicName>turn</topicName>
      <serviceName>turn/calibrate</serviceName></plugin></model>""")
    bench.call("/turn/calibrate")
    bench.run(0.01)
    assert {"call": "/turn/calibrate", "caller": ""} in lines()


def test_a_full_disk_ends_the_simulation_with_one_line(bench, caplog):
    StateLog(bench.simulation, Path("/dev/full"))
    bench.spawn(BOX.replace("NAME", "box"))
    bench.call("/gazebo/get_model_state", model_name="box")
    bench.run(0.2)
    assert caplog.text.count("/dev/full: No space left on device: the simulation ends") == 1
    assert bench.simulation.stopped()


def test_a_recording_has_the_scene_once_and_the_links_that_move_at_10_hz(bench, tmp_path):
    Recording(bench.simulation, tmp_path / "run.jsonl")
    bench.spawn(BOX.replace("NAME", "high"), Pose((0, 0, 5)))
    bench.run(0.4)
    bench.spawn(BOX.replace("NAME", "low"), Pose((3, 0, 0.5)))
    bench.run(0.2)
    lines = [json.loads(line) for line in (tmp_path / "run.jsonl").read_text().splitlines()]
    assert [next(iter(line)) for line in lines] == [
        "scene", "names", *["time"] * 4, "scene", "names", *["time"] * 2]
    assert set(scene_from_text(lines[0]["scene"]).links) >= {("high", "body")}
    assert lines[1] == {"names": ["high::body"], "scripted": 0}  # and not the ground's
    assert [line["time"] for line in lines[2:6]] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert lines[2]["poses"][0] == pytest.approx([0, 0, 5 - 0.049, 0, 0, 0, 1], abs=1e-3)
    assert len(lines[-1]["poses"]) == 2


def test_a_recording_has_actors_and_static_models_from_when_they_move(make_bench, tmp_path):
    shape = """<link name="link"><visual name="v"><geometry><sphere><radius>0.2</radius></sphere>
      </geometry></visual></link>"""
    bench = make_bench(f"""<sdf version="1.6"><world name="default">
      <actor name="walker">{shape}<script><trajectory id="0" type="way">
        <waypoint><time>0</time><pose>0 1 0 0 0 0</pose></waypoint>
        <waypoint><time>1</time><pose>2 1 0 0 0 0</pose></waypoint></trajectory></script></actor>
      <actor name="statue">{shape}<pose>0 9 0 0 0 0</pose></actor>
      <model name="door"><static>true</static>{shape}</model>
      <model name="wall"><static>true</static>{shape}</model></world></sdf>""")
    Recording(bench.simulation, tmp_path / "run.jsonl")
    bench.spawn(BOX.replace("NAME", "robot"), Pose((0, 0, 5)))
    bench.run(0.35)
    for x in (3.0, 0.0):  # there and back
        state = ModelState(model_name="door")
        state.pose.position.x = x
        bench.send("/gazebo/set_model_state", state)
        bench.run(0.1)
    lines = [json.loads(line) for line in (tmp_path / "run.jsonl").read_text().splitlines()]
    assert [line for line in lines if "names" in line] == [
        {"names": ["robot::body", *scripted], "scripted": len(scripted)} for scripted in (
            [], ["walker::link"], ["walker::link", "door::link"])]
    moments = [(line["time"], [x for x, *_ in line["poses"]]) for line in lines if "time" in line]
    walked = [x[1] for _, x in moments[1:]]
    assert walked == pytest.approx([0.4, 0.6, 0.8, 1.0], abs=2 / 30)
    assert [x[2:] for _, x in moments] == [[], [], [], [3.0], [0.0]]


def test_a_recording_on_a_full_disk_ends_and_the_simulation_goes_on(bench):
    Recording(bench.simulation, Path("/dev/full"))
    bench.run(0.3)
    assert bench.simulation.world.time == pytest.approx(0.3)
