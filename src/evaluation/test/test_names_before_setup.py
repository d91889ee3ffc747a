"""The scripts refuse a name before setup, by the same line as their programs after it."""

import subprocess
from pathlib import Path

import pytest
from ai_robot_tracking.scenes.scene import KINDS

from evaluation.autorace import TASKS
from run_session.course_file import drivers, load_course

SCRIPTS = Path(__file__).resolve().parents[3] / "scripts"


def followers(course):
    return drivers(load_course(course))


@pytest.mark.parametrize(("words", "line"), [
    (["course", "--follower", "5.py"],
     f"course: no follower '5.py' (FOLLOWER=); there are: {', '.join(followers('course'))}"),
    (["course", "--course", "race", "--follower", ""],
     f"course: no follower '' (FOLLOWER=); there are: {', '.join(followers('race'))}"),
    (["course", "--laps", "1", "--camera", "640"],
     "course: --camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got '640'"),
    (["track", "--scene", "dark"],
     f"track: no scene 'dark' (SCENE=); there are: {', '.join(KINDS)}"),
    (["autorace", "--mission", "park"],
     f"autorace: no mission 'park' (MISSION=); there are: {', '.join(TASKS)}"),
    (["chaos", "--course", "x"],
     "chaos: no course 'x' (COURSE=); there are: course, race, lane_empty"),
    (["soak", "--course", "x"],
     "soak: no course 'x' (COURSE=); there are: course, race, navigation"),
    (["mark", "--course", "x"],
     "mark: --course (COURSE=) must be one of course, race, lane, is 'x'")])
def test_a_wrong_name_is_refused_before_setup(words, line, tmp_path):
    (tmp_path / "scripts").mkdir()
    for script in SCRIPTS.glob("*.sh"):
        (tmp_path / "scripts" / script.name).symlink_to(script)
    (tmp_path / "scripts/setup.sh").unlink()
    (tmp_path / "scripts/setup.sh").write_text("#!/bin/sh\necho setup >&2\n")
    (tmp_path / "scripts/setup.sh").chmod(0o755)
    (tmp_path / "src").symlink_to(SCRIPTS.parent / "src")
    done = subprocess.run([tmp_path / "scripts" / f"{words[0]}.sh", *words[1:]], text=True,
                          capture_output=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"{line}\n")
