"""Course files: what they must hold, and the robot's name."""

import re
from pathlib import Path

import pytest
import yaml

from evaluation.command_line import BY_MAKE, NOT_RUN, option_of, run_program
from run_session.course_file import load_course
from run_session.failure import RunError

COURSES = Path(__file__).parent.parent / "courses"
ROOT = Path(__file__).resolve().parents[3]


def changed(tmp_path, **values) -> str:
    """A course file that differs from the line course; None takes a key out."""
    found = yaml.safe_load((COURSES / "course.yaml").read_text(encoding="utf-8")) | values
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({k: v for k, v in found.items() if v is not None}))
    return str(path)


@pytest.mark.parametrize("name", ["course", "race", "lane", "lane_empty"])
def test_our_own_courses_are_whole(name):
    course = load_course(name)
    assert course.track_path().is_file()
    assert course.camera in course.sensors


@pytest.mark.parametrize("name", ["course", "race", "lane", "lane_empty"])
def test_followers_are_found_wherever_the_package_is(name):
    course = load_course(name)
    assert course.follower in {path.name for path in course.follower_files()}


@pytest.mark.parametrize("program, elsewhere", [
    ("course_run", "scripts/course.sh --out DIR"),
    ("mark_drive", "make mark OUT=DIR (scripts/mark.sh --out DIR)")])
def test_a_folder_that_is_not_ours_is_one_line(capsys, program, elsewhere):
    def write() -> int:
        raise PermissionError(13, "Permission denied", "/out")

    assert run_program(program, write) == NOT_RUN
    assert capsys.readouterr().err == (
        f"{program}: you may not write /out: cd to a folder of yours, or give one: "
        f"{elsewhere}\n")


def test_messages_name_each_option_that_make_takes_of_all_trials():
    rules = re.split(r"\n(?=[a-z-]+:)", (ROOT / "Makefile").read_text(encoding="utf-8"))
    found = {(rule.partition(":")[0], word) for rule in rules for word in ("out", "resume")
             if re.search(rf"\$\(.*\b{word.upper()}\)", rule)}
    assert found == {(program, word) for program, words in BY_MAKE.items() for word in words}
    assert option_of("mark", "resume") == "--resume (RESUME=1)"
    assert option_of("avoid", "resume") == "--resume"


@pytest.mark.parametrize("values, said", [
    ({"camera": None}, "missing key 'camera'"),
    ({"speed": 3}, "unknown key 'speed'"),
    ({"off_course": "far"}, "off_course: must be a number, 0 or more, is 'far'"),
    ({"off_course": float("nan")}, "off_course: must be a number"),
    ({"off_course": True}, "off_course: must be a number"),
    ({"lockstep": "/cmd_vel"}, "lockstep: must be a list of topics, is '/cmd_vel'"),
    ({"launch": ["one"]}, "launch: must be [package, file], is ['one']"),
])
def test_a_mistake_names_file_and_key(tmp_path, values, said):
    with pytest.raises(RunError) as caught:
        load_course(changed(tmp_path, **values))
    assert "mine.yaml" in str(caught.value) and said in str(caught.value)


def test_a_file_that_is_no_text_or_not_there(tmp_path):
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RunError, match="not a text file"):
        load_course(str(tmp_path / "binary.yaml"))
    with pytest.raises(RunError, match="No such file"):
        load_course(str(tmp_path / "none.yaml"))


@pytest.mark.parametrize("text", ["a: 2020-13-45", "a: !!int ''", "a: !!bool x", "[" * 1000])
def test_what_the_yaml_parser_gives_up_on_is_no_yaml(tmp_path, text):
    (tmp_path / "mine.yaml").write_text(text)
    with pytest.raises(RunError, match=r"mine\.yaml: not valid YAML: [^\n]{1,300}$"):
        load_course(str(tmp_path / "mine.yaml"))


def test_the_controllers_are_those_of_the_lockstep_topics():
    assert load_course("course").controller_names() == set()
    names = load_course("race").controller_names()
    assert len(names) == 6 and "left_rear_wheel_velocity_controller" in names


def test_an_unknown_course_lists_those_that_there_are():
    with pytest.raises(RunError, match=r"no course .rally. .*course, lane, lane_empty, race"):
        load_course("rally")


def test_the_robot_is_that_of_the_argument_or_of_the_environment(monkeypatch):
    course = load_course("course")
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    assert course.robot_name(()) == "turtlebot3_waffle"
    monkeypatch.setenv("TURTLEBOT3_MODEL", "burger")
    assert course.robot_name(("yaw:=1",)) == "turtlebot3_burger"
    assert course.robot_name(("model:=waffle_pi",)) == "turtlebot3_waffle_pi"
    assert load_course("race").robot_name(("model:=x",)) == "racecar"
