"""A node that records a video of a case: the camera image beside the path driven."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import rospy
from racecar_description.track.track_file import load_track_file

from evaluation.course_run import CourseFilm
from evaluation.film import FILM_PERIOD
from marking.case_files import FILM, STATE_LOG, read_case, sample_of
from run_session.files import Tail

NODE = "/film"
LOOK_PERIOD = 0.1  # s, wall


def main(folder: Path) -> int:
    """Record the case of this folder until the node is shut down; returns the exit code."""
    case = read_case(folder)
    drive, robot, states = case.scorer(), case.robot(), Tail(folder / STATE_LOG)
    film = CourseFilm(folder / FILM, case.driven(), load_track_file(Path(case.track)), drive,
                FILM_PERIOD)
    rospy.init_node(NODE.strip("/"), disable_rosout=True)
    film.start()
    while not rospy.is_shutdown():
        for sample in (sample_of(json.loads(line), robot) for line in states.lines()):
            if sample is not None:
                drive.add(sample)
        rospy.rostime.wallsleep(LOOK_PERIOD)
    fault = film.close()
    if fault:
        print(f"film: {fault}", file=sys.stderr)
    return 1 if fault else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
