"""Samples of each process's resources and of simulated time."""

from __future__ import annotations

import contextlib
import math
import time
from typing import NamedTuple

import psutil
import rospy
from gazebo_msgs.srv import GetModelState
from rosgraph_msgs.msg import Clock

from run_session import simulator
from run_session.processes import processes
from run_session.simulator import call

PERIOD = 10.0  # s, wall, between two samples
FEWEST = 30  # samples of a short run
CLOCK = "clock"  # the row of simulated time
ALL = "all"  # the row of all processes together: grows if ever more are left behind
MEBIBYTE = 2**20


class Sample(NamedTuple):
    """A sample of one process, by its ROS name; of ALL; or of CLOCK; 0 where not applicable."""

    time: float  # s, wall, since the first
    name: str
    memory: float  # MiB in RAM
    descriptors: int
    threads: int
    pace: float  # simulated seconds per second since the last sample; 0 for a process
    rate: float  # messages of /clock per simulated second
    speed: float  # m/s, wall, of the robot in a straight line since the last sample


class Sampler:
    """Samples all descendants of this process, and the robot's position."""

    def __init__(self, robot: str) -> None:
        self._robot, self._place = robot, _place(robot)
        self._began = self._looked = time.monotonic()
        self._clocks = 0
        rospy.Subscriber("/clock", Clock, self._count, queue_size=100)
        self._simulated = rospy.get_time()

    def look(self) -> list[Sample]:
        """A row for the clock, one for ALL, and one for each process name, added up."""
        now, simulated = time.monotonic(), rospy.get_time()
        elapsed, passed = now - self._looked, simulated - self._simulated
        place = _place(self._robot)
        clock = Sample(now - self._began, CLOCK, 0.0, 0, 0, passed / elapsed,
                       self._clocks / max(passed, 1e-9), math.dist(place, self._place) / elapsed)
        self._looked, self._simulated, self._clocks = now, simulated, 0
        self._place = place
        found: dict[str, Sample] = {}
        for each in processes():
            with contextlib.suppress(psutil.NoSuchProcess):
                process = psutil.Process(each.pid)
                held = (each.memory / MEBIBYTE, process.num_fds(), process.num_threads())
                for name in (each.name, ALL):
                    before = found.get(name) or Sample(clock.time, name, 0.0, 0, 0, 0.0, 0.0, 0.0)
                    found[name] = before._replace(
                        memory=before.memory + held[0], descriptors=before.descriptors + held[1],
                        threads=before.threads + held[2])
        return [clock, *found.values()]

    def _count(self, _: Clock) -> None:
        self._clocks += 1


def _place(robot: str) -> tuple[float, float]:
    """x and y, m. RunError if there is no such model."""
    position = call(simulator.POSE, GetModelState, robot, "").pose.position
    return position.x, position.y
