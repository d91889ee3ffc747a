"""A learner opens, changes and runs lessons 01 to 05 in the lab, in Chromium, by clicks and keys.

The tests are one story, in this order, in one lab.
"""

import math
import shutil

import pytest
from lab_page import BUTTON, LabPage
from running_lab import ended, free_port, started, wait_until

pytestmark = [
    pytest.mark.processes, pytest.mark.timeout(900),
    pytest.mark.skipif(not shutil.which("chromium"), reason="no Chromium")]
# What is written into each lesson, the line above it, and what the terminal or the world shows.
EDITS = {
    "01follower.py": ('"""Called once', 'print("width", msg.width)', r"width 1920"),
    "02follower_opencv.py": ("image = self", 'print("grey", image.mean() > 0)', r"grey True"),
    "03follower_color_filter.py": ("mask = yellow", 'print("yellow", mask.any())', r"yellow True"),
    "04follower_line_finder.py": ("centre = find", 'print("line at", centre)', r"line at \(\d+, "),
}


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    lab = started(tmp_path_factory.mktemp("lab"), "--port", str(free_port()))
    yield lab
    assert ended(lab) == 0, lab.output.read_text()


@pytest.fixture(scope="module")
def page(lab):
    import chromium

    page = LabPage(lab, chromium)
    yield page
    page.close()


def test_lessons_1_to_4_are_opened_changed_and_run(lab, page):
    page.tile("Line course")
    wait_until(lambda: page.time() > 0, "world")
    page.world("page.querySelector('#tab-cameras').click()")
    picture = "page.querySelector('figure img')?.naturalWidth > 0"
    wait_until(lambda: page.world(picture), "picture of the camera")
    page.world("page.querySelector('#tab-services').click()")  # drawing takes what others need
    for name, (above, line, shown) in EDITS.items():
        script = page.open_lesson(name)
        page.add(script, above, line)
        page.run()
        lab.shown("run", shown)
        assert line in script.read_text("utf-8")
    page.world("page.querySelector('#tab-cameras').click()")
    window = "page.querySelector('figure[data-topic$=\"windows/findLine\"] img')?.naturalWidth > 0"
    wait_until(lambda: page.world(window), "window of lesson 4")
    page.world("page.querySelector('#tab-services').click()")
    # The browser asks for a page's pictures once before JupyterLab has put their addresses.
    assert not [error for error in page.page.errors if "/images/" not in error]


def test_the_robot_drives_by_lesson_5(lab, page):
    page.open_lesson("05follower_proporation.py")
    page.click(BUTTON, "Run")
    start = lab.positions()[0]
    wait_until(lambda: math.dist(lab.positions()[0], start) > 0.05, "robot that drives")
