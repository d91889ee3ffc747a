"""One watched drive, as `make course` starts it, and what a round may do to it."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from course import WATCHED, Course
from members import MARK, POLL, end_left_over, matching
from states import Place, driven, places

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "src" / "evaluation" / "scripts" / "course_run.py"
CAMERA = "320x240"  # px; the car is to move, not to keep its line
DURATION = 4.0  # s, simulated
STARTED = 0.02  # m
PACKAGE = "<package format='2'><name>chaos_course</name><version>0.0.0</version></package>\n"


class Drive:
    """Started at once; `results` is its folder for results, all else goes to `folder`."""

    def __init__(self, course: Course, folder: Path, results: Path, fast: bool, film: bool,
                 environment: dict[str, str]):
        self.course, self.folder, self.results = course, folder, results
        self.mark, self.states, self.log = str(folder), folder / "states", folder / "said"
        self._write_launch()
        words = ["--course", course.name, "--follower", course.follower, "--camera", CAMERA,
                 "--duration", f"{DURATION:g}", "--startup-timeout", "600",
                 "--stuck-timeout", "60", "--out", str(results), "--launch",
                 "chaos_course", "watched.launch",
                 *(["--fast"] if fast else []), *([] if film else ["--no-video"])]
        with self.log.open("wb") as output:
            self.judge = subprocess.Popen(
                [sys.executable, str(PROGRAM), *words], stdin=subprocess.DEVNULL, stdout=output,
                stderr=subprocess.STDOUT, start_new_session=True, cwd=folder,
                env={**os.environ, **environment, MARK: self.mark, "ROS_HOME": str(folder / "ros"),
                     "ROS_PACKAGE_PATH": f"{folder}:{os.environ['ROS_PACKAGE_PATH']}"})

    def places(self) -> list[Place]:
        """The car's so far."""
        return places(self.states, self.course.robot)

    def moves(self) -> bool:
        """Whether the car has set off."""
        return driven(self.places()) > STARTED

    def wait_for(self, condition: Callable[[], object], limit: float) -> bool:
        """Whether it came true within `limit` s, wall, while the judge lives."""
        until = time.monotonic() + limit
        while not condition():
            if self.judge.poll() is not None or time.monotonic() > until:
                return False
            time.sleep(POLL)
        return True

    def pids(self, victim: str) -> list[int]:
        """Of one of PATTERNS, or of a node."""
        if victim == "judge":
            return [self.judge.pid]
        return matching(self.mark, PATTERNS.get(victim, rf"__name:={victim}\b"))

    def wait(self, limit: float) -> int | None:
        """The judge's exit code; None if it has not ended within `limit`, s, wall."""
        try:
            return self.judge.wait(limit)
        except subprocess.TimeoutExpired:
            return None

    def close(self, grace: float) -> list[str]:
        """Command lines of what was left behind; nothing is afterwards."""
        if self.judge.poll() is None:
            self.judge.kill()
            self.judge.wait()
        return end_left_over(self.mark, grace)

    def _write_launch(self) -> None:
        package, file = self.course.launch
        text = WATCHED.format(states=self.states, package=package, file=file)
        (self.folder / "watched.launch").write_text(text, encoding="utf-8")
        (self.folder / "package.xml").write_text(PACKAGE, encoding="utf-8")


PATTERNS = {"simulator": r"__name:=gazebo\b", "master": r"bin/rosmaster\b",
            "roscore": r"bin/roscore\b", "roslaunch": r"bin/roslaunch\b",
            "encoder": r"^ffmpeg\b"}
