#!/usr/bin/env python3
"""Runs lessons 01 to 06 on the course and writes what they show to learning_topic/images."""

import argparse
import os
import sys
from pathlib import Path

import rospkg
import rospy

from evaluation.course_run.failure import RunError
from evaluation.course_run.launch import Launched
from evaluation.course_run.processes import Family
from evaluation.lesson_pictures import LESSONS, Photographer


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=Path, help="folder to write (default: the lessons')")
    parser.add_argument("--log", type=Path, default=Path("out/lesson_pictures"))
    options = parser.parse_args()
    folder = options.images or Path(rospkg.RosPack().get_path("learning_topic")) / "images"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with Family() as family:
            launched = Launched(family, options.log.resolve(), "")
            launched.start_roscore()
            os.environ["ROS_MASTER_URI"] = launched.master_uri
            rospy.init_node("lesson_pictures", disable_rosout=True)
            course = ["roslaunch", "learning_topic", "0course.launch", "gui:=false"]
            launched.start("roslaunch", course)
            photographer = Photographer(launched, folder)
            photographer.wait_for_car()
            for lesson in LESSONS:
                print(photographer.take(lesson))
    except (RunError, rospy.ROSException, rospy.ServiceException) as error:
        print(f"lesson_pictures: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
