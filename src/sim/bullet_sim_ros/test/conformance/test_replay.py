"""A run in lockstep is logged as it happened, and repeated from its log to the bit."""

import gzip
import json
from pathlib import Path

import pytest
from gazebo_msgs.msg import ModelState
from geometry_msgs.msg import Pose, Quaternion, Twist
from rosgraph_msgs.msg import Log

from bullet_sim.fingerprint import fingerprint
from bullet_sim.formats.run_log import part, read_run_log
from bullet_sim_ros.replay import Replay
from bullet_sim_ros.run_log import RunLog

BOX = """<collision name="c"><geometry><box><size>SIZE</size></box></geometry></collision>"""
WALL = f"""<model name="wall"><static>true</static><pose>1.2 0 0.5 0 0 0</pose><link name="l">
  {BOX.replace("SIZE", "0.1 4 1")}</link></model>"""
CAR = f"""<model name="car"><pose>0 0 0.1 0 0 0</pose>
  <link name="base"><inertial><mass>5</mass></inertial>{BOX.replace("SIZE", "0.4 0.2 0.2")}</link>
  <plugin name="drive" filename="libgazebo_ros_planar_move.so"><commandTopic>cmd_vel</commandTopic>
    <odometryTopic>odom</odometryTopic><odometryFrame>odom</odometryFrame>
    <robotBaseFrame>base</robotBaseFrame></plugin>
  <plugin name="imu" filename="libgazebo_ros_imu.so"><bodyName>base</bodyName>
    <topicName>turn</topicName><serviceName>turn/calibrate</serviceName>
    <updateRate>30</updateRate></plugin></model>"""
HERE = Pose(orientation=Quaternion(w=1.0))
LOCKSTEP = {"lockstep": "/cmd_vel", "lockstep_timeout": 1e-6, "lockstep_sensor": "/turn"}


def command(forward, turn=0.0):
    found = Twist()
    found.linear.x, found.angular.z = forward, turn
    return found


class Runs:
    """Runs one after the other in one ROS graph."""

    def __init__(self, graph, make_bench, folder):
        self._graph, self._make_bench = graph, make_bench
        self.path = folder / "run.log.gz"

    def bench(self, **world):
        """A new simulator with car and wall, paused."""
        self._graph.topics.clear()
        self._graph.services.clear()
        bench = self._make_bench(**world, **LOCKSTEP)
        bench.world.paused = True
        return bench

    def set_up(self, bench, car=CAR):
        for name, text in (("wall", WALL), ("car", car)):
            bench.call("/gazebo/spawn_sdf_model", model_name=name, initial_pose=HERE,
                       model_xml=f'<sdf version="1.6">{text}</sdf>')

    def first(self):
        """A run that is logged, up to its setup."""
        bench = self.bench()
        RunLog(bench.simulation, self.path)
        self.set_up(bench)
        bench.listen("/turn")
        bench.world.paused = False
        return bench

    def end(self, bench):
        for act in bench.simulation.at_close:
            act()
        return read_run_log(self.path)

    def again(self, car=CAR, **world):
        """A simulator that repeats it, set up."""
        bench = self.bench(**world)
        Replay(bench.simulation, self.path)
        self.set_up(bench, car)
        return bench

    def go_to(self, bench, number):
        self._graph.set_param("/gazebo/replay_to", number)
        return bench.call("/gazebo/go_to_image")


@pytest.fixture
def runs(graph, make_bench, tmp_path):
    return Runs(graph, make_bench, tmp_path)


@pytest.fixture
def driven(runs):
    """A run of a second, logged: its world's state by image, and its log."""
    bench, states = runs.first(), []
    bench.simulation.lockstep.each_question.append(
        lambda: states.append(fingerprint(bench.world)))
    for step, turn in ((7, 0.3), (61, -0.2), (1, 0.9), (333, 0.0)):
        bench.send("/cmd_vel", command(0.6, turn))
        bench.run_steps(step)
    state = bench.call("/gazebo/get_model_state", model_name="car")
    moved = ModelState(model_name="car", pose=state.pose, twist=state.twist)
    moved.pose.position.y += 0.05
    bench.call("/gazebo/set_model_state", model_state=moved)
    bench.send("/cmd_vel", command(0.4, 0.1))
    bench.run_steps(600)
    return states, runs.end(bench)


def test_each_image_is_as_in_the_run(runs, driven):
    states, log = driven
    bench = runs.again()
    for number in (1, 5, 6, 29):
        answer = runs.go_to(bench, number)
        assert answer.success, answer.message
        assert fingerprint(bench.world) == states[number - 1]
        assert bench.world.paused
    assert len(log.images) == len(states) == 29
    assert log.whole and log.header["seed"] == 1
    assert [name for name, _ in log.setup] == ["/gazebo/spawn_sdf_model"] * 2


def test_what_listens_or_not_makes_no_difference(runs, driven):
    states, _ = driven
    bench = runs.again()
    for topic in ("/turn", "/odom", "/gazebo/link_states"):
        bench.listen(topic)
    assert runs.go_to(bench, 29).success
    assert fingerprint(bench.world) == states[-1]
    assert not bench.graph.topics["/turn"].messages


def test_marks_of_contacts_and_of_the_program(runs):
    bench = runs.first()
    bench.send("/cmd_vel", command(1.0))
    bench.run(0.5)
    bench.send("/rosout", Log(msg="mark  the corner", name="/follower"))
    bench.send("/rosout", Log(msg="remarkable", name="/follower"))
    bench.run(1.0)
    found = runs.end(bench).marks
    assert [(mark.name, mark.text) for mark in found] == [
        ("the corner", "/follower"), ("contact", "car wall")]
    assert found[0].time == pytest.approx(0.5)
    assert 0.9 < found[1].time < 1.1


def test_messages_are_dropped_while_it_stands_and_taken_when_it_goes_on(runs, driven):
    states, log = driven
    bench = runs.again()
    assert runs.go_to(bench, 5).success
    time, standing = bench.world.time, fingerprint(bench.world)
    for _ in range(3):
        bench.send("/cmd_vel", command(5.0))
        bench.simulation.mailbox.run_pending()
    assert runs.go_to(bench, 29).success
    assert fingerprint(bench.world) == states[-1]
    assert time == log.time_of(log.images[4]) and standing == states[4]
    bench.world.paused = False
    bench.run_steps(1)
    bench.send("/cmd_vel", command(0.0, 3.0))
    bench.run(0.2)
    assert bench.world.model("car").twist.angular[2] == pytest.approx(3.0, abs=0.3)


def test_the_image_is_shown_to_who_comes_and_sent_again_when_it_goes_on(runs, driven):
    _, log = driven
    bench = runs.again()
    assert runs.go_to(bench, 5).success
    seen = bench.listen("/turn")

    def turn():
        for act in bench.simulation.each_turn:
            act()
    turn()
    turn()
    assert [message.header.stamp.to_sec() for message in seen] == [log.time_of(log.images[4])]
    bench.world.paused = False
    bench.run_steps(1)
    assert [message.header.stamp.to_sec() for message in seen] == [log.time_of(log.images[4])] * 2


def test_it_goes_forward_only_and_only_on_the_log(runs, driven):
    bench = runs.again()
    assert runs.go_to(bench, 7).success
    assert "the world is at image 7: only a new replay can go back" in runs.go_to(bench, 7).message
    bench.world.paused = False
    bench.run_steps(3)
    bench.world.paused = True
    assert runs.go_to(bench, 9).message == (
        "the world has gone on by itself: only a new replay can go back")


def test_behind_its_last_image_a_log_has_none(runs, driven):
    assert runs.go_to(runs.again(), 30).message == "the log ends at image 29"


def test_a_run_that_is_gone_back_to_can_be_gone_back_to(runs, driven, tmp_path):
    """Its own log has what was repeated."""
    _, log = driven
    bench = runs.bench()
    RunLog(bench.simulation, tmp_path / "second.gz")
    Replay(bench.simulation, runs.path)
    runs.set_up(bench)
    assert runs.go_to(bench, 12).success
    bench.listen("/turn")
    bench.world.paused = False
    bench.run_steps(1)
    runs.end(bench)
    second = read_run_log(tmp_path / "second.gz")
    assert second.images == log.images[:12]
    upto = log.events.index(log.images[11])
    assert second.events == log.events[:upto + 1]


# --- refusals


def test_a_robot_or_world_that_has_changed_is_refused(runs, driven):
    heavier = runs.again(CAR.replace("<mass>5", "<mass>6"))
    assert runs.go_to(heavier, 1).message.startswith(
        "the robot's description, or where it is spawned, has changed since the run")
    world = Path(__file__).with_name("conftest.py").read_text().split('GROUND = """')[1]
    other = runs.again(world_text=world.split('"""')[0].replace("0.001", "0.002"))
    assert "has changed since the run" in runs.go_to(other, 1).message
    assert runs.go_to(other, 1).message.startswith("the world ")


def test_a_state_that_differs_is_refused(runs, driven):
    lines = [json.loads(line) for line in
             gzip.decompress(runs.path.read_bytes()).splitlines()]
    [line for line in lines[1:] if line[0] == "i"][10][2] = "00000000"
    runs.path.write_bytes(part(lines))
    bench = runs.again()
    assert runs.go_to(bench, 10).success
    assert runs.go_to(bench, 11).message == (
        "the state at image 11 (0.374 s) differs from the run's")


def test_what_the_log_cannot_repeat_is_said(runs):
    bench = runs.first()
    bench.run(0.1)
    bench.call("/gazebo/pause_physics")
    bench.call("/gazebo/unpause_physics")  # neither changes what the world is at a step
    bench.call("/turn/calibrate")
    bench.run(0.1)
    log = runs.end(bench)
    assert [event.name for event in log.events if event.kind == "lacks"] == ["/turn/calibrate"]
    again = runs.again()
    assert runs.go_to(again, 2).success
    assert runs.go_to(again, 3).message == (
        "at 0.100 s the run used /turn/calibrate, which is not in its log")


def test_a_full_disk_ends_the_log_and_not_the_simulation(runs, caplog):
    bench = runs.bench()
    RunLog(bench.simulation, Path("/dev/full"))
    assert "No space left on device; the run cannot be gone back to" in caplog.text
    bench.world.paused = False
    bench.run(0.1)
    assert bench.world.time == pytest.approx(0.1)
