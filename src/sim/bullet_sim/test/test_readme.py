"""The READMEs name files that are there, and their picture is what its script draws."""

import re
import runpy
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1]
CORE = PACKAGE / "src" / "bullet_sim"
ROS = PACKAGE.parent / "bullet_sim_ros" / "src" / "bullet_sim_ros"
FILE = re.compile(r"`(ros:)?([\w/]+\.py|[\w/]+/)`")


@pytest.mark.parametrize("name", ["README.md", "README.zh-CN.md"])
def test_files_that_are_named_are_there(name):
    named = FILE.findall((PACKAGE / name).read_text(encoding="utf-8"))
    folders = {"ros:": [ROS], "": [CORE, PACKAGE]}
    if not ROS.is_dir():  # the core alone
        named = [entry for entry in named if not entry[0]]
    assert len(named) > 30
    assert not [path for kind, path in named
                if not any((folder / path).exists() for folder in folders[kind])]


def test_both_languages_name_the_same_files():
    english, chinese = (set(FILE.findall((PACKAGE / name).read_text(encoding="utf-8")))
                        for name in ("README.md", "README.zh-CN.md"))
    assert english == chinese


def test_the_picture_is_what_its_script_draws():
    drawn = runpy.run_path(str(PACKAGE / "scripts" / "make_figure.py"))["drawing"]()
    assert drawn == (PACKAGE / "images" / "overview.svg").read_text(encoding="utf-8")
