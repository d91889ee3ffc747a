"""The course with a waffle and lesson 05 over ROS, watched from within the lesson's process.

How old a frame is when a callback gets it is found on the wall clock. A frame's stamp is the
simulated moment at which it was taken. When that was on the wall is found from /clock: within
half a second around the stamp simulated time goes on at an even pace, and a /clock message can only
come late, never early. So the moment was due where the lower hull of the arrivals has it: the
earliest that any two messages around it allow. Where the simulator itself was behind that, its
lateness counts to the frame's age: the error is on the long side. What even the quickest message
needs on its way, well below a millisecond, is not in it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from run_session import simulator
from run_session.failure import RunError
from run_session.files import find_package
from run_session.processes import Child
from sim_bench.probes import CLOCK, FRAME
from sim_bench.ros_run import RosRun, read_lines

LESSON = "05follower_proporation.py"
COURSE_LAUNCH = ("learning_topic", "0course.launch", "gui:=false", "model:=waffle")
FOLLOWER = "follower"  # its process's name
IMAGES, COMMANDS = "/camera/rgb/image_raw", "/cmd_vel"
# As fast as it goes, paused until all are connected; and then the world waits for each command.
PAUSED = "paused:=true"
FAST = ("real_time_factor:=0", PAUSED)
LOCKSTEP = (*FAST, f"lockstep:={COMMANDS}")
CIRCLE = "{linear: {x: 0.15}, angular: {z: 0.3}}"  # m/s, rad/s
AROUND = 0.5  # s, simulated, to either side of a frame's stamp


class Seen(NamedTuple):
    """What a follower's process saw, in s, in the order of arrival."""

    frames: np.ndarray  # (n, 3): when a callback began, the image's stamp, what the callback took
    clock: np.ndarray  # (n, 2): a message's arrival, and its time

    def frames_between(self, start: float, end: float) -> np.ndarray:
        """The frames of a window of wall time (s)."""
        return self.frames[(start <= self.frames[:, 0]) & (self.frames[:, 0] < end)]


class Follower:
    """Lesson 05 as it is, on the course, with a camera of that size."""

    def __init__(self, run: RosRun, size: tuple[int, int], *arguments: str):
        """`arguments`: of the course's launch file. Returns when it drives; if that begins paused,
        time begins once both ends of the loop are connected. RunError for another size of frames.
        """
        lesson = find_package("learning_topic") / "scripts" / LESSON
        self._run, self._file = run, run.log_folder / "follower.txt"
        self._file.unlink(missing_ok=True)
        self.launched = launch_course(
            run, f"camera_width:={size[0]}", f"camera_height:={size[1]}", *arguments)
        self._child = run.probe(FOLLOWER, str(self._file), str(lesson))
        if PAUSED in arguments:
            run.wait(lambda: simulator.subscribers(IMAGES), "the follower's subscription")
            simulator.unpause()
        first = run.wait(lambda: self._rows(FRAME), "the first frame")[0]
        if first[3] != size[0]:
            raise RunError(f"the camera is {first[3]:.0f} px wide, not the {size[0]} asked for")

    def end(self) -> Seen:
        """What was seen; ends the lesson and the course."""
        seen = Seen(np.array(self._rows(FRAME))[:, [1, 2, 4]], np.array(self._rows(CLOCK))[:, 1:3])
        self._run.stop(self._child, self.launched)
        return seen

    def _rows(self, kind: int) -> list[tuple[float, ...]]:
        return [row for row in read_lines(self._file) if row[0] == kind]


def launch_course(run: RosRun, *arguments: str) -> Child:
    """Start 0course.launch without a screen; returns when the waffle is in the world."""
    launched = run.launch(*COURSE_LAUNCH, *arguments)
    run.wait(lambda: simulator.WAFFLE in simulator.models(), f"model {simulator.WAFFLE}")
    return launched


def send_circle(run: RosRun) -> Child:
    """A command that stands: the waffle drives a circle of 0.5 m radius until the child ends."""
    return run.start("rostopic", ["rostopic", "pub", COMMANDS, "geometry_msgs/Twist", CIRCLE])


def frame_ages(frames: np.ndarray, clock: np.ndarray) -> list[float]:
    """Age (s, wall) of each frame that has /clock on both sides; rows are as in `Seen`."""
    ages = []
    for wall, stamp in frames[:, :2]:
        first, last = np.searchsorted(clock[:, 1], (stamp - AROUND, stamp + AROUND))
        here = np.searchsorted(clock[:, 1], stamp, side="right")
        if first < here < last:
            ages.append(wall - _due(clock[first:here], clock[here:last], stamp))
    return ages


def _due(before: np.ndarray, after: np.ndarray, stamp: float) -> float:
    """The lower hull's wall time at a simulated moment; rows are (wall, simulated) around it."""
    share = (stamp - before[:, None, 1]) / (after[None, :, 1] - before[:, None, 1])
    return float(np.min(before[:, None, 0] * (1 - share) + after[None, :, 0] * share))
