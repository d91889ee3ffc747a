"""The READMEs name files that are there, and their picture is that of its source for Graphviz."""

import re
from pathlib import Path
from xml.etree import ElementTree

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


def test_the_picture_shows_what_its_source_says():
    source = (PACKAGE / "images" / "overview.dot").read_text(encoding="utf-8")
    picture = ElementTree.parse(PACKAGE / "images" / "overview.svg")
    said = re.findall(r"<b>(.+?)</b><br/>(.+?)>\]", source)
    texts = [*re.findall(r'label="(.+?)"', source), *(line for both in said for line in both)]
    assert len(said) == 18
    assert sorted(texts) == sorted(text.text for text in picture.findall(".//{*}text"))
    files = [name for name, _ in said if name.endswith((".py", "/"))]
    assert len(files) == 10 and all((CORE / name).exists() for name in files)
