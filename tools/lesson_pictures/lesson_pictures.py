#!/usr/bin/env python3
"""Runs lessons and writes what they show into the folder images of their packages.

  lesson_pictures.py [course|nav_demo|turtlebot3_slam|turtlebot3_navigation|racecar]

course, which is meant without a word: the windows of learning_topic's lessons 01 to 07. The others:
rviz on the way, each as its launch files open it, on a screen that nobody sees.
"""

import argparse
import os
import sys
from pathlib import Path

import rospkg
import rospy
from rviz_scenes import SCENES, Stage
from rviz_screen import Screen
from windows import LESSONS, Photographer

from run_session.failure import RunError
from run_session.interruption import interruptible
from run_session.launch import Launched
from run_session.processes import Family

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
                photograph_course(_start_master(family, options.log), options.images)
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
        scene(Stage(_start_master(family, options.log), screen, options.images, model))


def _start_master(family: Family, log: Path) -> Launched:
    launched = Launched(family, log.resolve(), "")
    launched.start_roscore()
    rospy.init_node("lesson_pictures", disable_rosout=True, disable_signals=True)
    return launched


if __name__ == "__main__":
    sys.exit(main())
