"""A simulator with the race's world and a lesson that drives in it, observed from outside."""

from __future__ import annotations

import json
import time
from pathlib import Path

import rospy
from gazebo_msgs.msg import ModelStates

from evaluation.autorace.judge import GROUND, Sample
from run_session import simulator
from run_session.failure import RunError
from run_session.launch import Launched

ROBOT = "autorace"
START_LIMIT, SILENCE = 240.0, 60.0  # s, wall
LOOK_PERIOD = 0.3  # s, wall
STATE_HZ = 10.0
SHOWN = ("traffic_light_", "traffic_bar_")


class Rig:
    """Made once per run; successive drives use the same ROS master."""

    def __init__(self, launched: Launched):
        self._launched = launched
        launched.start_roscore()
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/gazebo/pub_state_frequency", STATE_HZ)
        rospy.init_node("autorace_trials", disable_signals=True, disable_rosout=True)
        self.samples: list[Sample] = []
        rospy.Subscriber("/gazebo/model_states", ModelStates, self._take, queue_size=1)

    def begin(self, script: str, words: list[str], log: Path) -> None:
        """Start world, mission and lesson; the simulator stays paused."""
        self.samples = []
        self._log = log
        rospy.set_param("/gazebo/state_log", str(log))
        self._child = self._launched.start(log.stem, [
            "roslaunch", "learning_autorace", "autorace.launch", f"drive:={script}", "gui:=false",
            "paused:=true", "real_time_factor:=0", "lockstep:=/cmd_vel", "lockstep_timeout:=20",
            "pub_clock_frequency:=30", *words])
        self._launched.wait_for("the robot, the mission and the lesson", self._ready, START_LIMIT,
                                pause=LOOK_PERIOD)
        simulator.unpause()

    def watch(self) -> Sample:
        """The newest sample; RunError if none comes within SILENCE."""
        time.sleep(LOOK_PERIOD)
        until, count = time.monotonic() + SILENCE, len(self.samples)
        while len(self.samples) == count:
            self._launched.check(rospy.get_time())
            if time.monotonic() > until:
                raise RunError(f"no news of the robot for {SILENCE:.0f} s", self._launched.tail())
            time.sleep(LOOK_PERIOD)
        return self.samples[-1]

    def end(self) -> dict[str, float]:
        """End the drive; returns the touched models and the times of first contact, s."""
        self._launched.end(self._child)
        touched: dict[str, float] = {}
        for line in self._log.read_text(encoding="utf-8").splitlines():
            values = json.loads(line)
            for pair in values.get("contacts", []):
                for name in set(pair) - {ROBOT, *GROUND} if ROBOT in pair else ():
                    touched.setdefault(name, values["time"])
        return touched

    def _ready(self) -> bool:
        there = simulator.models()
        return (ROBOT in there and any(name.startswith(SHOWN[1]) for name in there)
                and bool(simulator.subscribers("/camera/image"))
                and bool(simulator.subscribers("/gazebo/model_states")))

    def _take(self, message: ModelStates) -> None:
        if ROBOT in message.name:
            place = message.pose[message.name.index(ROBOT)].position
            shown = frozenset(name for name in message.name if name.startswith(SHOWN))
            self.samples.append(Sample(rospy.get_time(), place.x, place.y, shown))
