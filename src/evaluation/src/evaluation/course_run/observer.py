"""What the run sees through ROS: the car's true pose, simulated time, counts of messages."""

from __future__ import annotations

import contextlib
import math
import os
import queue
import threading
import time
from collections.abc import Iterator

import rospy
from gazebo_msgs.srv import GetModelState, GetWorldProperties
from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo

from evaluation.lap import Sample

CAMERA_INFO, COMMANDS = "/camera/rgb/camera_info", "/cmd_vel"
WORLD, POSE = "/gazebo/get_world_properties", "/gazebo/get_model_state"
SAMPLE_RATE_HZ = 25.0
SETUP_RATE_HZ = 5.0


class Observer:
    """Asks for the car's pose 25 times a second.

    Asking costs the simulator less than /gazebo/model_states, which comes with every physics step
    and without a time. The node must exist before use_sim_time is set: then it needs no /clock.
    """

    def __init__(self, master_uri: str, robot: str):
        os.environ["ROS_MASTER_URI"] = master_uri
        self._robot = robot
        self._samples: queue.SimpleQueue[Sample] = queue.SimpleQueue()
        self._ended = threading.Event()
        self.simulator_up = False
        self.sim_time: float | None = None  # s, latest known
        self.frames_sent = 0
        self.commands = 0
        self._last_frame = self._first_frame = None  # header.seq
        rospy.init_node("course_run", anonymous=True, disable_signals=True, disable_rosout=True)
        self._thread = threading.Thread(target=self._watch, daemon=True, name="pose")

    def start(self) -> None:
        """Begin to ask and to count."""
        rospy.Subscriber(CAMERA_INFO, CameraInfo, self._count_frame, queue_size=100)
        rospy.Subscriber(COMMANDS, Twist, self._count_command, queue_size=100)
        self._thread.start()

    def stop(self) -> None:
        """Ask no more; does not wait for an answer that may never come."""
        self._ended.set()

    def samples(self, wait: float) -> list[Sample]:
        """All samples since the last call; waits this long (s, wall) for the first."""
        found = []
        with contextlib.suppress(queue.Empty):
            found.append(self._samples.get(timeout=wait))
            while True:
                found.append(self._samples.get_nowait())
        return found

    def _watch(self) -> None:
        for _ in self._ticks(SETUP_RATE_HZ, WORLD, GetWorldProperties):
            reply = self._call()
            if reply is not None:
                self.simulator_up, self.sim_time = True, reply.sim_time
                if self._robot in reply.model_names:
                    break
        for _ in self._ticks(SAMPLE_RATE_HZ, POSE, GetModelState):
            reply = self._call(self._robot, "world")
            if reply is not None and reply.success:
                self.sim_time = reply.header.stamp.to_sec()
                self._samples.put(_to_sample(self.sim_time, reply.pose))

    def _ticks(self, rate_hz: float, service: str, kind: type) -> Iterator[None]:
        """Times to ask a service; the connection stays open and is made again when it broke."""
        self._service, self._kind, self._proxy = service, kind, None
        while not self._ended.is_set():
            began = time.monotonic()
            yield
            self._ended.wait(max(0.0, began + 1.0 / rate_hz - time.monotonic()))

    def _call(self, *arguments: str) -> object | None:
        try:
            if self._proxy is None:
                self._proxy = rospy.ServiceProxy(self._service, self._kind, persistent=True)
            return self._proxy(*arguments)
        except (rospy.ServiceException, rospy.ROSException, OSError):
            self._proxy = None
            return None

    def _count_frame(self, message: CameraInfo) -> None:
        self._last_frame = message.header.seq
        if self._first_frame is not None:
            self.frames_sent = self._last_frame - self._first_frame + 1

    def _count_command(self, _message: Twist) -> None:
        """Pictures count from the one that the follower's first command answers."""
        if self._first_frame is None:
            self._first_frame = self._last_frame
        self.commands += 1


def _to_sample(sim_time: float, pose: object) -> Sample:
    q = pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return Sample(sim_time, pose.position.x, pose.position.y, yaw)
