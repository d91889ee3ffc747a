"""The examples run, are short, and do what their first line says."""

import re
import runpy
import sys
from pathlib import Path

import cv2
import pytest

FOLDER = Path(__file__).resolve().parents[1] / "examples"
LONGEST = 40  # lines
OUTPUT = {
    "drive_robot": r"4\.00 s: x 0\.5\d\d m, y 0\.5\d\d m, yaw 1\.[56]\d\d\n$",
    "read_laser": r"of 181 beams hit something; the nearest is 1\.59 m away at 19 degrees\n$",
    "take_picture": r"picture\.png: 320 x 240 pixels\n$",
    "two_robots": r"^a and b touch after [12]\.\d\d s at x -?0\.0\d\d m with \d+ N\n$",
}


def test_each_example_is_here():
    assert {path.stem for path in FOLDER.glob("*.py")} == set(OUTPUT)


@pytest.mark.parametrize("name", OUTPUT)
def test_example(name, tmp_path, monkeypatch, capsys):
    path = FOLDER / f"{name}.py"
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGEST
    assert not re.search(r"import _|\._[a-z]", text), "it uses what is not public"
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(path)])
    runpy.run_path(str(path), run_name="__main__")
    assert re.search(OUTPUT[name], capsys.readouterr().out)


def test_the_picture_shows_the_cone_and_the_ground(tmp_path, monkeypatch, capsys):
    file = tmp_path / "a.png"
    monkeypatch.setattr(sys, "argv", ["take_picture.py", str(file)])
    runpy.run_path(str(FOLDER / "take_picture.py"), run_name="__main__")
    blue, green, red = cv2.split(cv2.imread(str(file)).astype(int))
    assert ((red > 150) & (green < 110) & (blue < 90)).sum() > 200, "no orange cone"


def test_a_picture_that_cannot_be_written_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["take_picture.py", str(tmp_path / "none" / "a.png")])
    with pytest.raises(SystemExit, match=r"a\.png cannot be written; give the name"):
        runpy.run_path(str(FOLDER / "take_picture.py"), run_name="__main__")
