"""The scripts refuse a name before setup, by the same line as their programs after it."""

import subprocess
from pathlib import Path

import pytest
from ai_robot_tracking.scenes.scene import KINDS

from evaluation.autorace import TASKS
from evaluation.lane_trials import known_methods
from evaluation.track import TRACKERS
from run_session.course_file import drivers, load_course

SCRIPTS = Path(__file__).resolve().parents[3] / "scripts"


def followers(course):
    return drivers(load_course(course))


@pytest.mark.parametrize(("words", "line"), [
    (["course", "--follower", "5.py"],
     f"course: no follower '5.py' (FOLLOWER=); there are: {', '.join(followers('course'))}"),
    (["course", "--course", "race", "--follower", ""],
     f"course: no follower '' (FOLLOWER=); there are: {', '.join(followers('race'))}"),
    (["course", "--follower", "5.py", "--course", "race"],
     f"course: no follower '5.py' (FOLLOWER=); there are: {', '.join(followers('race'))}"),
    (["course", "--laps", "1", "--camera", "640"],
     "course: --camera (CAMERA=) must be WIDTHxHEIGHT in px, as 640x480; got '640'"),
    (["track", "--scene", "dark"],
     f"track: no scene 'dark' (SCENE=); there are: {', '.join(KINDS)}"),
    (["track", "--tracker", "pid"],
     f"track: no tracker 'pid' (TRACKER=); there are: {', '.join(TRACKERS)}"),
    *(([script, "--method", "magic"],
       f"{script}: no method 'magic' (METHOD=); there are: {', '.join(known_methods())}")
      for script in ("lane_trials", "lane")),
    (["replay", "--at", "lost", "--run", "out/nope"],
     "replay: no run at out/nope (RUN=): give the folder of its results, as out/course"),
    (["autorace", "--mission", "park"],
     f"autorace: no mission 'park' (MISSION=); there are: {', '.join(TASKS)}"),
    (["chaos", "--course", "x"],
     "chaos: no course 'x' (COURSE=); there are: course, race, lane_empty"),
    (["soak", "--course", "x"],
     "soak: no course 'x' (COURSE=); there are: course, race, navigation"),
    *((["lab", "--port", port], f"lab: port is {port}; give one from 1024 to 65535, such as "
                                "PORT=8889") for port in ("80", "70000", "x")),
    (["mark", "--course", "x"],
     "mark: --course (COURSE=) must be one of course, race, lane, is 'x'")])
def test_a_wrong_name_is_refused_before_setup(words, line, tmp_path):
    assert with_a_setup_that_fails(words, tmp_path) == (2, f"{line}\n")


@pytest.mark.parametrize("words", [
    ["--course", "nope", "--follower", "x"],
    ["--follower", followers("race")[0], "--course", "race"]])
def test_what_is_not_known_here_is_the_programs_to_refuse(words, tmp_path):
    """An unknown course, and a follower of the course that is named after it."""
    assert with_a_setup_that_fails(["course", *words], tmp_path) == (2, "setup\n")


def with_a_setup_that_fails(words, folder):
    """Exit code and stderr of a script, whose setup says "setup" and fails."""
    (folder / "scripts").mkdir()
    for script in SCRIPTS.glob("*.sh"):
        (folder / "scripts" / script.name).symlink_to(script)
    (folder / "scripts/setup.sh").unlink()
    (folder / "scripts/setup.sh").write_text("#!/bin/sh\necho setup >&2\nexit 1\n")
    (folder / "scripts/setup.sh").chmod(0o755)
    (folder / "src").symlink_to(SCRIPTS.parent / "src")
    done = subprocess.run([folder / "scripts" / f"{words[0]}.sh", *words[1:]], text=True,
                          stdin=subprocess.PIPE, capture_output=True, timeout=60)
    assert done.stdout == ""
    return done.returncode, done.stderr
