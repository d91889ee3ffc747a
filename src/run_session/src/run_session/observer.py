"""Observes a run through ROS: the car's true pose, simulated time, counts of messages."""

from __future__ import annotations

import contextlib
import queue
import threading
import time
import xmlrpc.client
from collections.abc import Callable, Iterable, Mapping, Set

import rosgraph
import rospy
from controller_manager_msgs.srv import ListControllers
from gazebo_msgs.srv import GetModelState, GetWorldProperties
from geometry_msgs.msg import Pose, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo
from std_srvs.srv import Empty

from run_session import names
from run_session.asking import Asker
from run_session.connections import Connections, look_up
from run_session.course import Course
from run_session.frames import FrameCount
from run_session.simulator import place_of

Seen = tuple[float, float, float, float]  # s, simulated; x, y, m; yaw, rad, in the world
SAMPLE_RATE_HZ = 25.0
SETUP_RATE_HZ = 5.0
LAST_IMAGE_TIME, LAST_COMMAND_TIME = 1.0, 0.1  # s, wall, to wait for them


class Observer:
    """Records where the car is; in lockstep it also starts time, once all nodes are connected.

    Without lockstep it requests the pose 25 times a second: that costs the simulator less than
    /gazebo/model_states, which has no time stamp. In lockstep it takes the poses from odometry,
    which the waffle's drive takes from the world: they come at fixed simulated times, so that
    every run is scored from the same samples, and delay nothing.
    The node must exist before use_sim_time is set: then it needs no /clock.
    """

    def __init__(self, master_uri: str, robot: str, course: Course, lockstep: bool = False,
                 listened: Iterable[str] = ()):
        """`listened`: further topics that must be connected before time begins, in lockstep."""
        self._course, self._listened = course, tuple(listened)
        self._master_uri, self._robot, self._lockstep = master_uri, robot, lockstep
        self._samples: queue.SimpleQueue[tuple[float, Seen]] = queue.SimpleQueue()
        self._ended = threading.Event()
        self._asker = Asker(self._ended)
        self.missing = f"the simulator (service {names.WORLD})"
        self.frames = FrameCount(lockstep)
        rospy.init_node("course_run", anonymous=True, disable_signals=True, disable_rosout=True)
        self._thread = threading.Thread(target=self._watch, daemon=True, name="pose")

    def start(self) -> None:
        """Begin to observe and count."""
        rospy.Subscriber(self._course.camera_info, CameraInfo, self.frames.count_frame)
        rospy.Subscriber(self._course.commands, Twist, self.frames.count_command)
        if self._lockstep:
            rospy.Subscriber(self._course.odometry, Odometry, self._take_odometry)
        self._thread.start()

    def stop(self) -> None:
        """Stop observing; does not wait for an answer that may never come."""
        self._ended.set()

    def samples(self, wait: float) -> list[tuple[float, Seen]]:
        """All samples since the last call, after a wait (s, wall), each with its arrival time.

        Arrivals are s of time.monotonic().
        """
        self._ended.wait(wait)
        found = []
        with contextlib.suppress(queue.Empty):
            while True:
                found.append(self._samples.get_nowait())
        return found

    def count(self, until: float) -> tuple[int, int]:
        """Number of images up to this simulated time (s), and of commands received.

        Waits briefly for messages still in transit; later commands answer later images.
        """
        frames = self.frames
        _wait_for(lambda: frames.later_than(until), LAST_IMAGE_TIME)
        _wait_for(lambda: frames.commands >= frames.sent(until), LAST_COMMAND_TIME)
        return frames.sent(until), frames.commands

    def _watch(self) -> None:
        self._wait_for_car()
        if self._lockstep:
            if self._course.controllers:
                self._wait_for_controllers()
            self._wait_for_connections()
            self._begin()
        else:
            self._ask_poses()

    def _wait_for_car(self) -> None:
        for _ in self._asker.ticks(SETUP_RATE_HZ, names.WORLD, GetWorldProperties):
            reply = self._asker.call()
            if reply is None:
                continue
            self.missing = f"the car (model {self._robot})"
            if self._robot in reply.model_names:
                return

    def _wait_for_controllers(self) -> None:
        """Wait until they run, or will with the first step: a paused world starts no controller."""
        service = f"{self._course.controllers}/{names.LIST_CONTROLLERS}"
        self.missing = f"the car's controllers (service {service})"
        for _ in self._asker.ticks(SETUP_RATE_HZ, service, ListControllers):
            reply = self._asker.call()
            if reply is None:
                continue
            missing = missing_controller({each.name: each.state for each in reply.controller},
                                         self._course.controller_names())
            if missing is None:
                return
            self.missing = missing

    def _wait_for_connections(self) -> None:
        me, course = rospy.get_name(), self._course
        topics = (course.camera, course.camera_info, course.commands, course.odometry,
                  *course.lockstep, *self._listened)
        for _ in self._asker.ticks(SETUP_RATE_HZ):
            try:
                missing = missing_connection(look_up(self._master_uri, me, topics), me, course)
            except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
                continue
            if missing is None:
                return
            self.missing = missing

    def _begin(self) -> None:
        self.missing = f"the beginning of simulated time (service {names.UNPAUSE})"
        for _ in self._asker.ticks(SETUP_RATE_HZ, names.UNPAUSE, Empty):
            if self._asker.call() is not None:
                self.missing = f"the first pose (topic {self._course.odometry})"
                return

    def _ask_poses(self) -> None:
        for _ in self._asker.ticks(SAMPLE_RATE_HZ, names.POSE, GetModelState):
            reply = self._asker.call(self._robot, "world")
            if reply is not None and reply.success:
                self._put(reply.header.stamp, reply.pose)

    def _take_odometry(self, message: Odometry) -> None:
        self._put(message.header.stamp, message.pose.pose)

    def _put(self, stamp: rospy.Time, pose: Pose) -> None:
        self._samples.put((time.monotonic(), (stamp.to_sec(), *place_of(pose))))


def missing_controller(states: Mapping[str, str], wanted: Set[str]) -> str | None:
    """The controller that a run in lockstep still waits for, in words; None: none.

    All loaded controllers have to be started, too: one that starts later drives differently.
    """
    started = {name for name, state in states.items() if state in ("running", "waiting")}
    missing = sorted((wanted | states.keys()) - started)
    if missing or not states:
        return f"controller {(missing or ['of the car'])[0]} (spawned and started)"
    return None


def missing_connection(found: Connections, me: str, course: Course) -> str | None:
    """What a run in lockstep still waits for before time begins, in words; None: nothing.

    From the first image on, the follower must answer, and this node (`me`) get pose and answer.
    """
    watching = found.subscribers[course.camera] - {me}
    driving = found.publishers[course.commands] - {me}
    if not found.publishers[course.camera]:
        return f"the camera (topic {course.camera})"
    if not found.publishers[course.odometry]:
        return f"the odometry (topic {course.odometry})"
    if not watching:
        return f"the follower (nobody subscribes to {course.camera})"
    if not driving:
        return f"the follower (nobody publishes {course.commands})"
    if not found.subscribers[course.commands] - driving - {me}:
        return f"the car's drive (nobody subscribes to {course.commands})"
    mute = [topic for topic in course.lockstep if not found.publishers[topic]]
    if mute:
        return f"the car's control (nobody publishes {mute[0]})"
    deaf = [topic for topic in course.lockstep if not found.subscribers[topic] - {me}]
    if deaf:
        return f"the car's control (nobody subscribes to {deaf[0]})"
    silent = [topic for topic in course.sensors if not found.publishers.get(topic, {me})]
    if silent:
        return f"the car's sensors (nobody publishes {silent[0]})"
    links = (found.missing_link(topic) for topic in found.publishers)
    return next((link for link in links if link), None)


def _wait_for(condition: Callable[[], bool], limit: float) -> None:
    until = time.monotonic() + limit
    while not condition() and time.monotonic() < until:
        time.sleep(0.005)
