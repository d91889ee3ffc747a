"""The theory's pictures are what tools/makers/theory_pictures.py draws today."""

import importlib.util
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = ROOT / "tools/makers/theory_pictures.py"
PAGES = {"learning_topic": "learning_topic/THEORY", "lane_keeping": "lessons/lane_keeping/README",
         "ai_robot_tracking": "lessons/ai_robot_tracking/README"}
LEAST_ALIKE = 2.0  # of 255, in the mean: another release of FreeType or Mesa rounds otherwise


@pytest.fixture(scope="module")
def theory():
    spec = importlib.util.spec_from_file_location("theory_pictures", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_shipped_pictures_are_todays(theory, tmp_path):
    for package, folder, name, draw_into in theory.listed():
        theory.write(draw_into, tmp_path / "again.png")
        shipped, again = (cv2.imread(str(path)).astype(int)
                          for path in (folder / f"{name}.png", tmp_path / "again.png"))
        assert shipped.shape == again.shape == (300, 640, 3)
        assert np.abs(shipped - again).mean() < LEAST_ALIKE, f"{package}: draw {name} again"


def test_a_picture_drawn_twice_is_the_same_file(theory, tmp_path):
    files = [tmp_path / "one.png", tmp_path / "two.png"]
    for file in files:
        theory.write(theory.distance, file)
    assert files[0].read_bytes() == files[1].read_bytes()


@pytest.mark.parametrize("package", PAGES)
@pytest.mark.parametrize("suffix", (".md", ".zh-CN.md"))
def test_the_page_shows_them(theory, package, suffix):
    text = (ROOT / "src" / (PAGES[package] + suffix)).read_text(encoding="utf-8")
    shown = re.findall(r"\]\(images/(theory\d*)\.png\)", text)
    assert shown == [name for each, _, name, _ in theory.listed() if each == package]
