"""The lessons' pure functions on drawn images with known answers, without a master."""

import ast
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest

SCRIPTS = pathlib.Path(__file__).resolve().parents[1] / "scripts"
PATH = str(SCRIPTS / "pose_subscriber.py")
YELLOW, WHITE, GREEN, RED, BLUE = (
    (0, 255, 255), (255, 255, 255), (0, 255, 0), (0, 0, 255), (255, 0, 0),
)


def road(*lines, height=1080, width=1920):
    """A black BGR image with upright lines (first column, last column, colour)."""
    image = np.zeros((height, width, 3), np.uint8)
    for first, last, colour in lines:
        image[:, first : last + 1] = colour
    return image


@pytest.mark.parametrize("path", sorted(SCRIPTS.glob("*.py")), ids=lambda path: path.name)
def test_every_script_starts_by_itself(path):
    assert path.read_text().startswith("#!/usr/bin/env python3\n")
    assert os.access(path, os.X_OK), f"chmod +x {path}"
    compile(path.read_text(), path, "exec")


def test_no_two_scripts_or_launch_files_share_a_name():
    """rosrun takes what can be run, wherever in the package: solutions cannot."""
    names = [path.name for path in SCRIPTS.parent.rglob("*") if path.suffix == ".launch"
             or (path.suffix == ".py" and os.access(path, os.X_OK))]
    assert len(names) == len(set(names))


@pytest.mark.parametrize("path", sorted(SCRIPTS.glob("0*.py")), ids=lambda path: path.name)
def test_a_lesson_has_at_most_95_code_lines(path):
    """Without empty lines, comments and docstrings."""
    text = path.read_text(encoding="utf-8")
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docstrings = [node.body[0] for node in ast.walk(ast.parse(text))
                  if isinstance(node, documented) and ast.get_docstring(node)]
    documentation = {line for each in docstrings
                     for line in range(each.lineno, each.end_lineno + 1)}
    code = [line for number, line in enumerate(text.splitlines(), 1)
            if line.strip() and not line.lstrip().startswith("#") and number not in documentation]
    assert len(code) <= 95


def test_all_lessons_that_drive_end_alike():
    """Taught in lesson 5; lesson 7's own idea is what happens without images."""
    texts = [path.read_text(encoding="utf-8") for path in sorted(SCRIPTS.glob("0[567]*.py"))]
    stops = {text[text.index("    def stop(self):"):text.index("def main():")] for text in texts}
    mains = {text[text.index("def main():"):] for text in texts[:2]}
    assert len(texts) == 3 and len(stops) == len(mains) == 1


@pytest.mark.parametrize("path", sorted(SCRIPTS.glob("*.py")), ids=lambda path: path.name)
def test_lessons_import_only_messages_and_what_every_robot_has(path):
    allowed = {"rospy", "cv2", "cv_bridge", "numpy", "math", "sys", "time"}
    allowed |= {"geometry_msgs", "sensor_msgs", "turtlesim", "learning_topic"}
    for node in ast.walk(ast.parse(path.read_text())):
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module] if isinstance(node, ast.ImportFrom) else []
        assert {name.split(".")[0] for name in names} <= allowed


def test_blue_channel_is_blue(lesson):
    image = road((0, 9, BLUE), (10, 19, RED), width=20, height=4)
    assert lesson(2).blue_channel(image)[0].tolist() == [255] * 10 + [0] * 10


@pytest.mark.parametrize("number", [3, 4, 5])
@pytest.mark.parametrize(
    ("colour", "kept"), [(YELLOW, 255), (GREEN, 255), (WHITE, 0), (RED, 0), (BLUE, 0)]
)
def test_mask_keeps_the_tutorials_range(lesson, number, colour, kept):
    mask = lesson(number).yellow_mask(road((0, 3, colour), width=4, height=2))
    assert (mask == kept).all()


@pytest.mark.parametrize(("number", "top"), [(4, 810), (5, 900), (6, 900)])
def test_finds_the_middle_of_the_line_in_the_band(lesson, number, top):
    assert lesson(number).find_line(road((900, 920, YELLOW))) == (910, top + 9)


@pytest.mark.parametrize(("number", "top"), [(4, 810), (5, 900)])
def test_only_the_band_of_20_rows_counts(lesson, number, top):
    image = road((900, 920, YELLOW))
    image[top : top + 20] = 0
    assert lesson(number).find_line(image) is None
    image[top + 19, 300] = YELLOW
    assert lesson(number).find_line(image) == (300, top + 19)


def test_lesson_4_shows_only_the_band(lesson):
    mask = lesson(4).band_mask(road((900, 920, YELLOW)))
    assert np.flatnonzero(mask.any(axis=1)).tolist() == list(range(810, 830))
    assert np.flatnonzero(mask.any(axis=0)).tolist() == list(range(900, 921))


@pytest.mark.parametrize("number", [4, 5])
def test_odd_sizes_have_a_band_too(lesson, number):
    assert lesson(number).find_line(road((10, 20, YELLOW), height=479, width=641))[0] == 15


@pytest.mark.parametrize("number", [4, 5])
def test_no_line_is_none(lesson, number):
    assert lesson(number).find_line(road((5, 30, WHITE))) is None


@pytest.mark.parametrize(("offset_px", "turn"), [(0, 0.0), (100, -0.1), (-250, 0.25)])
def test_lesson_5_turns_towards_the_line(lesson, offset_px, turn):
    assert lesson(5).steer(offset_px) == pytest.approx(turn)


def test_lesson_5_drives_as_the_tutorial_says(lesson):
    assert lesson(5).SPEED == 0.15


def test_without_turtlesim_one_line_says_what_to_do():
    code = f"import runpy, sys; sys.modules['turtlesim'] = None; runpy.run_path({PATH!r})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1 and "turtlesim" in done.stderr


@pytest.mark.parametrize("name", ["06follower_pid", "07follower_ground"])
@pytest.mark.parametrize("value", ["abc", True, [1.0]])
def test_a_parameter_that_is_no_number_ends_a_lesson_with_a_line(name, value):
    program = f"""import importlib.util, rospy
rospy.get_param = lambda name, default: {value!r} if name == "~speed" else default
spec = importlib.util.spec_from_file_location("lesson", {str(SCRIPTS / name) + ".py"!r})
lesson = importlib.util.module_from_spec(spec)
spec.loader.exec_module(lesson)
assert lesson.number("gain", 2) == 2
lesson.number("speed", 0.2)"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                           timeout=60, check=False)
    assert (ended.returncode, ended.stderr) == (
        1, f"{name}.py: ~speed must be a number, not {value!r}\n")
