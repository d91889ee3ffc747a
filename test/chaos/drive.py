"""One supervised drive, started as by `make course` or by hand, with access to its processes."""

from __future__ import annotations

import os
import subprocess
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path

from course import WATCHED, CourseUnderTest
from members import MARK, end_left_over, matching, wait_until
from states import Place, driven, places

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "src" / "evaluation" / "scripts" / "course_run.py"
CAMERA = "320x240"  # px; the car only has to move, not to keep to the line
DURATION = 4.0  # s, simulated
STARTED = 0.02  # m
LAUNCH = ("chaos_course", "watched.launch")
PACKAGE = "<package format='2'><name>chaos_course</name><version>0.0.0</version></package>\n"


class Watched(ABC):
    """A drive whose car is tracked by the simulator's own log, and whose processes are known."""

    def __init__(self, course: CourseUnderTest, folder: Path, environment: dict[str, str]):
        self.course, self.folder = course, folder
        self.mark, self.states = str(folder), folder / "states"
        self._environment = {
            **os.environ, **environment, MARK: self.mark, "ROS_HOME": str(folder / "ros"),
            "ROS_PACKAGE_PATH": f"{folder}:{os.environ['ROS_PACKAGE_PATH']}"}
        (folder / "package.xml").write_text(PACKAGE, encoding="utf-8")

    def places(self) -> list[Place]:
        """The car's poses so far."""
        return places(self.states, self.course.robot)

    def now(self) -> float:
        """Simulated time, s."""
        seen = self.places()
        return seen[-1][0] if seen else 0.0

    def moves(self) -> bool:
        """Whether the car has set off."""
        return driven(self.places()) > STARTED

    @abstractmethod
    def lives(self) -> bool:
        """Whether the supervised processes are still running."""

    def wait_for(self, condition: Callable[[], object], limit: float) -> bool:
        """Whether the condition became true within `limit` s, wall, while the drive lives."""
        return bool(wait_until(lambda: condition() or not self.lives(), limit) and condition())

    def pids(self, victim: str) -> list[int]:
        """Process ids of one of PATTERNS, or of a node."""
        return matching(self.mark, PATTERNS.get(victim, rf"__name:={victim}\b"))

    def close(self, grace: float) -> list[str]:
        """Kill processes that were left behind; returns their command lines."""
        return end_left_over(self.mark, grace)

    def _write_launch(self, launch: tuple[str, str]) -> None:
        package, file = launch
        text = WATCHED.format(states=self.states, package=package, file=file)
        (self.folder / LAUNCH[1]).write_text(text, encoding="utf-8")


class JudgedDrive(Watched):
    """Starts immediately; `results` is the folder for results, all else goes to `folder`."""

    def __init__(self, course: CourseUnderTest, folder: Path, results: Path, fast: bool, film: bool,
                 environment: dict[str, str]):
        super().__init__(course, folder, environment)
        self.results, self.log = results, folder / "said"
        self._write_launch(course.launch)
        words = ["--course", course.name, "--follower", course.follower, "--camera", CAMERA,
                 "--duration", f"{DURATION:g}", "--startup-timeout", "600",
                 "--stuck-timeout", "60", "--out", str(results), "--launch", *LAUNCH,
                 *(["--fast"] if fast else []), *([] if film else ["--no-video"])]
        with self.log.open("wb") as output:
            self.judge = subprocess.Popen(
                [sys.executable, str(PROGRAM), *words], stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, start_new_session=True, cwd=folder,
                env=self._environment)

    def lives(self) -> bool:
        """Whether the judge is running."""
        return self.judge.poll() is None

    def pids(self, victim: str) -> list[int]:
        """As in the base class, with the judge too."""
        return [self.judge.pid] if victim == "judge" else super().pids(victim)

    def wait(self, limit: float) -> int | None:
        """The judge's exit code; None if it has not ended within `limit`, s, wall."""
        try:
            return self.judge.wait(limit)
        except subprocess.TimeoutExpired:
            return None

    def close(self, grace: float) -> list[str]:
        """Kill processes that were left behind; returns their command lines."""
        if self.lives():
            self.judge.kill()
            self.judge.wait()
        return super().close(grace)


PATTERNS = {"simulator": r"__name:=gazebo\b", "master": r"bin/rosmaster\b",
            "roscore": r"bin/roscore\b", "roslaunch": r"bin/roslaunch\b",
            "encoder": r"^ffmpeg\b"}
