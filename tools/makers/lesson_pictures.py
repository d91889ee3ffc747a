#!/usr/bin/env python3
"""Runs lessons and writes what they show into the folder images of their packages.

  lesson_pictures.py [course|nav_demo|turtlebot3_slam|turtlebot3_navigation|racecar]

course, which is meant without a word: the windows of learning_topic's lessons 01 to 07. The others:
rviz on the way, each as its launch files open it, on a screen that nobody sees.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import rosgraph
import rospkg
import rospy
from cv_bridge import CvBridge
from gazebo_msgs.srv import GetWorldProperties
from node_basics.ending import interruptible
from rviz_pictures import SCENES, Screen, Stage
from sensor_msgs.msg import Image
from std_srvs.srv import Empty

from evaluation.picture import FONT, PAPER, TEXT, bgr, write_text
from run_session.failure import RunError
from run_session.launch import Launched
from run_session.processes import Family
from run_session.simulator import WORLD

WINDOW_WIDTH_PX, BAR_PX, GAP_PX = 640, 34, 14
LETTER_PX, LINE_PX = 10, 21
START_TIME, WINDOW_TIME = 60.0, 20.0  # s, wall
HZ_TIME = 6.0  # s, wall, that rostopic hz counts


@dataclass(frozen=True)
class Lesson:
    """One script, and how many simulated seconds it runs before its picture is taken."""

    script: str
    drive_time: float = 1.0
    windows: int = 1

    @property
    def number(self) -> str:
        return self.script[:2]

    @property
    def window_topics(self) -> re.Pattern:
        """Of the node as it is named here, so that no earlier lesson is taken for it."""
        return re.compile(f"^/lesson_{self.number}/windows/(.+)$")


LESSONS = (
    Lesson("01follower.py", windows=0),
    Lesson("02follower_opencv.py"),
    Lesson("03follower_color_filter.py", windows=2),
    Lesson("04follower_line_finder.py", windows=2),
    Lesson("05follower_proporation.py", drive_time=9.0),
    Lesson("06follower_pid.py", drive_time=9.0),
    Lesson("07follower_ground.py", drive_time=9.0),
)


class Photographer:
    """Runs one lesson after the other in a simulation that is already up."""

    def __init__(self, launched: Launched, folder: Path):
        self._launched, self._folder = launched, folder
        self._world = rospy.ServiceProxy(WORLD, GetWorldProperties)

    def wait_for_car(self) -> None:
        """Wait until the car stands on the course."""
        until = time.monotonic() + START_TIME
        while not any(name.startswith("turtlebot3_") for name in self._models()):
            self._launched.check(None)
            if time.monotonic() > until:
                raise RunError(f"no car within {START_TIME:.0f} s", self._launched.tail())
            time.sleep(0.2)

    def take(self, lesson: Lesson) -> Path:
        """Run a lesson from the start of the course and write its picture."""
        rospy.ServiceProxy("/gazebo/reset_world", Empty)()
        name = [f"__name:=lesson_{lesson.number}"] if lesson.windows else []
        command = ["rosrun", "learning_topic", lesson.script, *name]
        child = self._launched.start(lesson.script, command)
        try:
            picture = self._windows(lesson) if lesson.windows else _checks_of_lesson_1()
        finally:
            self._launched.end(child)
        path = self._folder / f"{lesson.number}.png"
        cv2.imwrite(str(path), picture, [cv2.IMWRITE_PNG_COMPRESSION, 9])
        return path

    def _windows(self, lesson: Lesson) -> np.ndarray:
        """All windows of the lesson side by side, after its time of driving."""
        topics = _wait_for(lambda: self._topics(lesson), f"windows of {lesson.script}")
        began = self._world().sim_time
        while self._world().sim_time < began + lesson.drive_time:
            self._launched.check(began)
            time.sleep(0.05)
        frames = []
        for topic in topics:
            message = rospy.wait_for_message(topic, Image, timeout=WINDOW_TIME)
            frame = CvBridge().imgmsg_to_cv2(message, "bgr8")
            frames.append(_window(lesson.window_topics.search(topic)[1], frame))
        gap = np.full((frames[0].shape[0], GAP_PX, 3), 255, np.uint8)
        return np.hstack([part for frame in frames for part in (frame, gap)][:-1])

    def _topics(self, lesson: Lesson) -> list[str]:
        published = rosgraph.Master("/lesson_pictures").getPublishedTopics("")
        names = [name for name, _ in published if lesson.window_topics.search(name)]
        return sorted(names, reverse=True) if len(names) >= lesson.windows else []

    def _models(self) -> list[str]:
        try:
            return self._world().model_names
        except rospy.ServiceException:
            return []


def _wait_for(condition: Callable[[], list], what: str) -> list:
    until = time.monotonic() + WINDOW_TIME
    while time.monotonic() < until:
        found = condition()
        if found:
            return found
        time.sleep(0.1)
    raise RunError(f"{what}: none within {WINDOW_TIME:.0f} s")


def _window(title: str, frame: np.ndarray) -> np.ndarray:
    """A picture in a window's frame."""
    height = round(frame.shape[0] * WINDOW_WIDTH_PX / frame.shape[1])
    page = np.full((height + BAR_PX, WINDOW_WIDTH_PX, 3), bgr(PAPER), np.uint8)
    page[BAR_PX:] = cv2.resize(frame, (WINDOW_WIDTH_PX, height), interpolation=cv2.INTER_AREA)
    write_text(page, title, (12, BAR_PX - 11), 13, bgr(TEXT))
    return page


def _checks_of_lesson_1() -> np.ndarray:
    """A terminal with the three commands by which a learner checks lesson 1."""
    _wait_for(lambda: re.findall(r"/follower\n", _output("rosnode", "list")), "node /follower")
    info = _output("rosnode", "info", "/follower").splitlines()
    subscriptions = [line for line in info if "Subscriptions" in line or "image_raw" in line][:2]
    rates = _output("timeout", "-s", "INT", str(HZ_TIME), "rostopic", "hz", "/camera/rgb/image_raw")
    lines = ["$ rosnode list", *_output("rosnode", "list").split()]
    lines += ["$ rosnode info /follower", *subscriptions]
    lines += ["$ rostopic hz /camera/rgb/image_raw"]
    lines += [line for line in rates.splitlines() if "rate" in line or "min:" in line][-2:]
    return terminal_page([line.rstrip() for line in lines])


def _output(*command: str) -> str:
    done = subprocess.run(command, capture_output=True, text=True, timeout=30.0, check=False)
    return done.stdout


def terminal_page(lines: list[str]) -> np.ndarray:
    """Text as a terminal shows it: letters in columns, commands brighter."""
    width = max(WINDOW_WIDTH_PX, max(map(len, lines)) * LETTER_PX + 24)
    page = np.full((len(lines) * LINE_PX + 24, width, 3), bgr(PAPER), np.uint8)
    for row, line in enumerate(line.expandtabs(4) for line in lines):
        colour = (140, 230, 160) if line.startswith("$") else bgr(TEXT)
        for column, letter in enumerate(line):
            at = (12 + column * LETTER_PX, 12 + row * LINE_PX + 15)
            cv2.putText(page, letter, at, FONT, 0.42, colour, 1, cv2.LINE_AA)
    return page


COURSE = "course"


def main() -> int:
    """The exit status: 0, or 1 with one line that says what went wrong; 130 after Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", nargs="?", choices=[COURSE, *SCENES], default=COURSE)
    parser.add_argument("--images", type=Path, help="folder to write (default: the packages')")
    parser.add_argument("--log", type=Path, default=Path("out/lesson_pictures"))
    options = parser.parse_args()
    try:
        with interruptible(), Family() as family:
            if options.scene == COURSE:
                photograph_course(start_master(family, options.log), options.images)
            else:
                photograph_scene(family, options)
    except (RunError, rospy.ROSException, rospy.ServiceException) as error:
        print(f"lesson_pictures: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("lesson_pictures: interrupted; all processes ended", file=sys.stderr)
        return 130
    return 0


def photograph_course(launched: Launched, images: Path | None) -> None:
    """The lessons on the course, one after the other."""
    folder = images or Path(rospkg.RosPack().get_path("learning_topic")) / "images"
    folder.mkdir(parents=True, exist_ok=True)
    launched.start("roslaunch", ["roslaunch", "learning_topic", "0course.launch", "gui:=false"])
    photographer = Photographer(launched, folder)
    photographer.wait_for_car()
    for lesson in LESSONS:
        print(photographer.take(lesson))


def photograph_scene(family: Family, options: argparse.Namespace) -> None:
    """What rviz shows in one of SCENES."""
    model, scene = SCENES[options.scene]
    made = options.log.resolve() / "models"  # where a scene makes models of its own
    known = os.environ.get("GAZEBO_MODEL_PATH", "")
    with Screen() as screen:
        os.environ.update(screen.environment, GAZEBO_MODEL_PATH=f"{made}{os.pathsep}{known}")
        scene(Stage(start_master(family, options.log), screen, options.images, model))


def start_master(family: Family, log: Path) -> Launched:
    launched = Launched(family, log.resolve(), "")
    launched.start_roscore()
    rospy.init_node("lesson_pictures", disable_rosout=True, disable_signals=True)
    return launched


if __name__ == "__main__":
    sys.exit(main())
