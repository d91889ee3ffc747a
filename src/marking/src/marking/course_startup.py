"""Starts a case's course, and says what a submission still has to do before time begins."""

from __future__ import annotations

import itertools
import sys
import time
import xmlrpc.client
from pathlib import Path

import rosgraph
import rospy
from gazebo_msgs.srv import GetWorldProperties

from evaluation.run_page import RECORDING, begin_recording
from marking import conduct, film, guard
from marking.case_files import CaseFile
from marking.rules import Rules
from run_session import simulator
from run_session.files import Tail
from run_session.launch import MAY_FINISH, Launched
from run_session.master import Connections, look_up
from run_session.observer import missing_connection
from run_session.processes import Child

ME = "/judge"  # never registered at the master
STARTUP_LIMIT = 240.0  # s, wall, for the course: the machine may be busy
LOOK_PERIOD = 0.1  # s, wall
STEADY_TIME = 2.0  # s, wall, without a change at the master: the course is complete


class CourseStartup:
    """A course without a driver, paused."""

    def __init__(self, launched: Launched, case: CaseFile, folder: Path, state_log: Path):
        """RunError if it does not come up; `state_log` is the file that the simulator writes."""
        self._launched, self._case, self._course = launched, case, case.driven()
        self._watching = {ME}  # nodes that subscribe to the camera but are no drivers
        self._own_nodes: frozenset[str] = frozenset()
        self._registered: list | None = None  # the master's state, unchanged since
        self._since = 0.0  # s, wall
        launched.start_roscore()
        self._master = rosgraph.Master(ME, launched.master_uri)
        self._master.setParam("/gazebo/state_log", str(state_log))
        begin_recording(launched.master_uri, folder / RECORDING)
        launched.start("roslaunch", ["roslaunch", *self._course.launch, *case.launch_args])
        launched.wait_for("the course", self._is_ready, STARTUP_LIMIT, pause=LOOK_PERIOD)
        self.film = self._start_film(folder) if case.film else None
        found = self._connections()
        guard.check_guarded(self._master, frozenset().union(*found.subscribers.values()), folder)

    def look_around(self, rules: Rules) -> tuple[conduct.CourseNodes, Tail]:
        """The ROS graph before the submission starts, and the master's log from here on."""
        publishers, subscribers, services = self._master.getSystemState()
        registered = [*publishers, *subscribers, *services]
        master_log = Tail(self._launched.log_folder / "latest" / "master.log")
        master_log.skip()
        self._own_nodes = frozenset(node for _, nodes in registered for node in nodes)
        return conduct.CourseNodes(
            frozenset(node for node in self._own_nodes
                      if not any(word in node for word in MAY_FINISH)),
            frozenset(name for name, _ in [*publishers, *subscribers]),
            frozenset(name for name, _ in services),
            frozenset(self._master.getParamNames()),
            frozenset([*rules.may_publish, self._course.commands])), master_log

    def missing_link(self) -> str | None:
        """What the submission still has to do before time begins, in words; None: nothing."""
        try:
            found = self._connections()
        except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
            return "answered"
        course = self._course
        if not found.subscribers[course.camera] - self._watching:
            return f"subscribed to {course.camera}"
        if not found.publishers[course.commands]:
            return f"advertised {course.commands}"
        missing = missing_connection(found, ME, course)
        # Without the nodes' names: anonymous ones differ from run to run.
        return f"made {missing.partition(' from ')[0]}" if missing else None

    def has_driver(self) -> bool:
        """Whether the submission has a registered node."""
        registered = itertools.chain(*self._master.getSystemState())
        return any(node not in self._own_nodes for _, nodes in registered for node in nodes)

    def _is_ready(self) -> bool:
        """Whether the robot and all that a driver needs are there."""
        try:
            reply = rospy.ServiceProxy(simulator.WORLD, GetWorldProperties)()
            found, registered = self._connections(), self._master.getSystemState()
        except (rospy.ServiceException, OSError, xmlrpc.client.Error, rosgraph.MasterException):
            return False
        course = self._course
        needed = (course.camera, course.camera_info, course.odometry, *course.lockstep)
        if registered != self._registered:
            self._registered, self._since = registered, time.monotonic()
        return (self._case.robot() in reply.model_names
                and all(found.subscribers[topic] for topic in (course.commands, *course.lockstep))
                and all(found.publishers[topic] for topic in needed if topic != course.commands)
                and time.monotonic() - self._since > STEADY_TIME)

    def _start_film(self, folder: Path) -> Child:
        child = self._launched.start(
            "film", [sys.executable, "-P", "-m", film.__name__, str(folder)])
        self._launched.wait_for(
            "the film", lambda: film.NODE in self._connections().subscribers[
                self._course.camera], STARTUP_LIMIT, pause=LOOK_PERIOD)
        self._watching.add(film.NODE)
        return child

    def _connections(self) -> Connections:
        course = self._course
        return look_up(self._launched.master_uri, ME, (
            course.camera, course.camera_info, course.commands, course.odometry, *course.lockstep))
