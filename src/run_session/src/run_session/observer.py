"""Observes a run through ROS: the car's true pose, simulated time, messages and their checksums."""

from __future__ import annotations

import bisect
import contextlib
import hashlib
import queue
import struct
import threading
import time
import xmlrpc.client
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from typing import Any

import rosgraph
import rospy
from controller_manager_msgs.srv import ListControllers
from gazebo_msgs.srv import GetModelState, GetWorldProperties
from geometry_msgs.msg import Pose, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo
from std_srvs.srv import Empty

from run_session import simulator
from run_session.course_file import CourseFile
from run_session.master import Connections, look_up
from run_session.simulator import place_of


def ticks(ended: threading.Event, rate_hz: float) -> Iterator[None]:
    """Yields at this rate (wall time) until `ended` is set."""
    while not ended.is_set():
        began = time.monotonic()
        yield
        ended.wait(max(0.0, began + 1.0 / rate_hz - time.monotonic()))


def poll(ended: threading.Event, rate_hz: float, service: str, kind: type, *arguments: str
         ) -> Iterator[Any]:
    """The service's responses, called at this rate (wall time) until `ended` is set.

    Keeps the connection open, and reconnects when a call fails, which yields nothing.
    """
    proxy = None
    for _ in ticks(ended, rate_hz):
        try:
            proxy = proxy or rospy.ServiceProxy(service, kind, persistent=True)
            reply = proxy(*arguments)
        except simulator.FAILURES:
            proxy = None
        else:
            yield reply


UNANSWERED_SAYS = "lockstep: no message on"  # in the simulator's warning, at most every 10 s


class FrameCount:
    """Images are counted by header.seq, so that one missed here counts as well.

    In lockstep they count from the first one, because the follower runs from the beginning;
    otherwise from the one that its first command answers.
    """

    def __init__(self, lockstep: bool):
        self._lockstep = lockstep
        self._first: int | None = None  # header.seq
        self._numbers: list[int] = []  # header.seq of each image
        self._times: list[float] = []  # s, simulated
        self.commands = 0

    def count_frame(self, message: CameraInfo) -> None:
        """Count one more image, by its CameraInfo, which is smaller."""
        if self._lockstep and self._first is None:
            self._first = message.header.seq
        self._numbers.append(message.header.seq)
        self._times.append(message.header.stamp.to_sec())

    def count_command(self, _message: Twist) -> None:
        """Count one more command; a follower sends one for each image."""
        if self._first is None and self._numbers:
            self._first = self._numbers[-1]
        self.commands += 1

    def sent(self, until: float) -> int:
        """Number of images that count, stamped up to this simulated time (s)."""
        seen = bisect.bisect_right(self._times, until)
        if self._first is None or not seen:
            return 0
        return max(0, self._numbers[seen - 1] - self._first + 1)

    def later_than(self, time: float) -> bool:
        """Whether an image after this simulated time (s) has arrived, and so all before it."""
        return bool(self._times) and self._times[-1] > time


def frame_figures(sent: int, commands: int, lockstep_log: list[str] | None) -> dict:
    """Images sent, answered and dropped.

    A follower answers each image with one command, so images without a command were dropped in
    transit or by the follower. In lockstep (when the run's log is given) all are answered, unless
    the simulator logged that it went on without an answer.
    """
    dropped = max(sent - commands, 0)
    if lockstep_log is not None:
        went_on = any(UNANSWERED_SAYS in line for line in lockstep_log)
        dropped = max(dropped, 1) if went_on else 0
    return {"frames_sent": sent, "frames_answered": sent - dropped, "frames_dropped": dropped}


SEQ_AND_STAMP = struct.Struct("<III")  # how a serialised std_msgs/Header begins


class Fingerprints:
    """Takes the raw messages of all sensor topics; each begins with a header.

    rospy allows one message type per topic and node: nothing else here may subscribe to these.
    """

    def __init__(self, topics: Iterable[str]):
        self._topics = topics
        self._lock = threading.Lock()
        self._rows: dict[str, list[tuple[int, float, bytes]]] = {}  # seq, stamp in s, SHA-256

    def start(self) -> None:
        """Subscribe."""
        for topic in self._topics:
            rows = self._rows[topic] = []
            rospy.Subscriber(topic, rospy.AnyMsg, self._take, callback_args=rows, queue_size=None,
                             buff_size=2**22, tcp_nodelay=True)

    def _take(self, message: rospy.AnyMsg, rows: list) -> None:
        seq, secs, nsecs = SEQ_AND_STAMP.unpack_from(message._buff)
        row = seq, secs + 1e-9 * nsecs, hashlib.sha256(message._buff).digest()
        with self._lock:
            rows.append(row)

    def sums(self, until: float, limit: float) -> dict[str, str | None]:
        """For each topic the checksum of its messages up to this simulated time (s).

        Waits for messages still in transit, at most `limit` s, wall. None if a message was missed:
        then the checksum would be meaningless.
        """
        _wait_for(lambda: self._later_than(until), limit)
        with self._lock:
            return {topic: _sum(rows, until) for topic, rows in self._rows.items()}

    def _later_than(self, time_s: float) -> bool:
        with self._lock:
            return all(rows and rows[-1][1] > time_s for rows in self._rows.values())


def _sum(rows: list[tuple[int, float, bytes]], until: float) -> str | None:
    counted = [row for row in rows if row[1] <= until]
    if not counted or counted[-1][0] - counted[0][0] != len(counted) - 1:
        return None
    return hashlib.sha256(b"".join(digest for _, _, digest in counted)).hexdigest()


Seen = tuple[float, float, float, float]  # s, simulated; x, y, m; yaw, rad, in the world
SAMPLE_RATE_HZ = 25.0
SETUP_RATE_HZ = 5.0
LAST_COMMAND_TIME = 0.1  # s, wall, to wait for it


class Observer:
    """Records where the car is; in lockstep it also starts time, once all nodes are connected.

    Without lockstep it requests the pose 25 times a second: that costs the simulator less than
    /gazebo/model_states, which has no time stamp. In lockstep it takes the poses from odometry,
    which the waffle's drive takes from the world: they come at fixed simulated times, so that
    every run is scored from the same samples, and delay nothing.
    The node must exist before use_sim_time is set: then it needs no /clock.
    """

    def __init__(self, master_uri: str, robot: str, course: CourseFile, lockstep: bool = False,
                 listened: Iterable[str] = ()):
        """`listened`: further topics that must be connected before time begins, in lockstep."""
        self._course, self._listened = course, tuple(listened)
        self._master_uri, self._robot, self._lockstep = master_uri, robot, lockstep
        self._samples: queue.SimpleQueue[tuple[float, Seen]] = queue.SimpleQueue()
        self._ended = threading.Event()
        self.missing = f"the simulator (service {simulator.WORLD})"
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

    def count(self, until: float, limit: float) -> tuple[int, int]:
        """Number of images up to this simulated time (s), and of commands received.

        Waits for images still in transit, at most `limit` s, wall; later commands answer later
        images.
        """
        frames = self.frames
        _wait_for(lambda: frames.later_than(until), limit)
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
        for reply in poll(self._ended, SETUP_RATE_HZ, simulator.WORLD, GetWorldProperties):
            self.missing = f"the car (model {self._robot})"
            if self._robot in reply.model_names:
                return

    def _wait_for_controllers(self) -> None:
        """Wait until they run, or will with the first step: a paused world starts no controller."""
        service = f"{self._course.controllers}/{simulator.LIST_CONTROLLERS}"
        self.missing = f"the car's controllers (service {service})"
        for reply in poll(self._ended, SETUP_RATE_HZ, service, ListControllers):
            missing = missing_controller({each.name: each.state for each in reply.controller},
                                         self._course.controller_names())
            if missing is None:
                return
            self.missing = missing

    def _wait_for_connections(self) -> None:
        me, course = rospy.get_name(), self._course
        topics = (course.camera, course.camera_info, course.commands, course.odometry,
                  *course.lockstep, *self._listened)
        for _ in ticks(self._ended, SETUP_RATE_HZ):
            try:
                missing = missing_connection(look_up(self._master_uri, me, topics), me, course)
            except (OSError, xmlrpc.client.Error, rosgraph.MasterException):
                continue
            if missing is None:
                return
            self.missing = missing

    def _begin(self) -> None:
        self.missing = f"the beginning of simulated time (service {simulator.UNPAUSE})"
        for _ in poll(self._ended, SETUP_RATE_HZ, simulator.UNPAUSE, Empty):
            self.missing = f"the first pose (topic {self._course.odometry})"
            return

    def _ask_poses(self) -> None:
        for reply in poll(self._ended, SAMPLE_RATE_HZ, simulator.POSE, GetModelState,
                          self._robot, "world"):
            if reply.success:
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
        name = f"controller {missing[0]}" if missing else "the car's controllers"
        return f"{name} (spawned and started)"
    return None


def missing_connection(found: Connections, me: str, course: CourseFile) -> str | None:
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
