"""The course with a waffle and lesson 05 over ROS, for the parts that measure them at work."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import rospkg

from run_session import simulator
from run_session.failure import RunError
from run_session.processes import Child
from sim_bench.probes.follower import CLOCK, FRAME
from sim_bench.ros_run import START_LIMIT, RosRun, read_lines

LESSON = "05follower_proporation.py"
COURSE_LAUNCH = ("learning_topic", "0course.launch", "gui:=false", "model:=waffle")
SIMULATOR, FOLLOWER = "gazebo", "follower"  # names of the processes
IMAGES, COMMANDS = "/camera/rgb/image_raw", "/cmd_vel"


@dataclass(frozen=True)
class Seen:
    """What a follower's process saw; pairs are (wall, simulated) in s, in order of arrival."""

    frames: list[tuple[float, float]]  # when a callback began, and the image's stamp
    clock: list[tuple[float, float]]
    callbacks: list[float]  # s, what each callback took

    def between(self, start: float, end: float) -> Seen:
        """What was seen in a window of wall time (s)."""
        inside = [start <= wall < end for wall, _ in self.frames]
        return Seen(
            [frame for frame, yes in zip(self.frames, inside) if yes],
            [pair for pair in self.clock if start <= pair[0] < end],
            [took for took, yes in zip(self.callbacks, inside) if yes],
        )


class Follower:
    """Lesson 05 as it is, watched from within its own process."""

    def __init__(self, run: RosRun, width: int):
        lesson = Path(rospkg.RosPack().get_path("learning_topic")) / "scripts" / LESSON
        self._run, self._width = run, width
        self._file = run.folder / "follower.txt"
        self._file.unlink(missing_ok=True)
        self.child: Child = run.probe("follower", str(self._file), str(lesson))

    def wait_until_listening(self) -> None:
        """Returns when the simulator may send: both ends of the loop are connected."""
        self._run.wait(
            lambda: simulator.subscribers(IMAGES), START_LIMIT, "the follower's subscription"
        )

    def wait_until_driving(self) -> None:
        """Returns when frames come; RunError if they are not of the size that was asked for."""
        self._run.wait(self._rows_of_frames, START_LIMIT, "the first frame")
        width = int(self._rows_of_frames()[0][3])
        if width != self._width:
            raise RunError(f"the camera is {width} px wide, not the {self._width} asked for")

    def seen(self) -> Seen:
        """All until now."""
        rows = read_lines(self._file)
        frames = [row for row in rows if row[0] == FRAME]
        return Seen(
            [(row[1], row[2]) for row in frames],
            [(row[1], row[2]) for row in rows if row[0] == CLOCK],
            [row[4] for row in frames],
        )

    def _rows_of_frames(self) -> list[tuple[float, ...]]:
        return [row for row in read_lines(self._file) if row[0] == FRAME]


def launch_course(run: RosRun, *arguments: str) -> Child:
    """0course.launch without a screen; returns when the waffle stands in it."""
    launched = run.launch(*COURSE_LAUNCH, *arguments)
    run.wait(lambda: simulator.WAFFLE in simulator.models(), START_LIMIT,
             f"model {simulator.WAFFLE}")
    return launched


def camera_arguments(width: int, height: int) -> tuple[str, ...]:
    """Launch arguments that make the waffle's camera of that size; none for its usual one."""
    if (width, height) == (1920, 1080):
        return ()
    return (f"camera_width:={width}", f"camera_height:={height}")


def fast_arguments(lockstep: bool) -> tuple[str, ...]:
    """Launch arguments for as fast as it goes, paused until all are connected."""
    listening = (f"lockstep:={COMMANDS}",) if lockstep else ()
    return ("real_time_factor:=0", "paused:=true", *listening)
