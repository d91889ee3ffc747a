"""The page's time bar: in a replay it goes to each image, in a run that goes on it says how."""

import os
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from replay_seeds import drive
from test_replay_live import Replay

from bullet_sim.formats.run_log import Mark, append_marks, read_run_log

LIMIT = 120.0  # s, wall
sys.path.append(str(Path(__file__).resolve().parents[2] / "sim/sim_viewer/test"))
pytestmark = [pytest.mark.processes, pytest.mark.timeout(3 * LIMIT),
              pytest.mark.skipif(not shutil.which("chromium"), reason="no Chromium")]
MOMENT = "document.querySelector('#moment-text')?.textContent?"


@pytest.fixture
def browser():
    import chromium
    made = chromium.Browser()
    yield made
    made.close()


def wait_for_image(page, number):
    page.wait_for(f"{MOMENT}.includes('image {number}/')"
                  " && !document.querySelector('footer.busy')", LIMIT)


def drag_to(page, time):
    page.evaluate(f"{{ const bar = document.querySelector('#moment'); bar.value = {time};"
                  "for (const kind of ['input', 'change']) bar.dispatchEvent(new Event(kind)); }")


def test_in_a_replay_the_bar_goes_to_each_image_and_drives_on(browser, tmp_path):
    path = drive("course", 3, tmp_path / "run", 5)
    append_marks(path, [Mark("lost", 3.0, "beside the line"), Mark("my corner", 4.0)])
    log = read_run_log(path)
    replay = Replay("--run", path, "--at", "2.0", "--control", "--out", tmp_path / "replay")
    follower = None
    try:
        url = re.search(r"http://\S+", replay.wait_for("the page in the browser: "))[0]
        page = browser.open(url)
        wait_for_image(page, log.image_at(2.0))
        assert page.evaluate("[...document.querySelectorAll('.mark')].map((one) => one.title)"
                             ".filter((one) => !one.includes('largest'))") == [
            "line lost (beside the line), 3.00 s", "my corner, 4.00 s"]
        page.evaluate("document.querySelector('#image-next').click()")
        wait_for_image(page, log.image_at(2.0) + 1)
        page.evaluate("document.querySelector('.mark.lost').click()")
        wait_for_image(page, log.image_at(3.0))
        page.evaluate("document.querySelector('#moment').focus()")
        page.key("ArrowLeft", True)
        page.key("ArrowLeft", False)
        wait_for_image(page, log.image_at(3.0) - 1)
        drag_to(page, 1.5)
        wait_for_image(page, log.image_at(1.5))
        replay.wait_for(f"image {log.image_at(1.5)} of {len(log.images)}, ")
        page.evaluate("document.querySelector('#drive-on').click()")
        page.wait_for("document.querySelector('#moment-said').textContent"
                      ".startsWith('no program sends /cmd_vel: in another terminal, ')", LIMIT)
        joined = next(line for line in replay.lines if " ROS_MASTER_URI=" in line)
        uri = joined.partition("ROS_MASTER_URI=")[2].partition(";")[0]
        follower = subprocess.Popen(["rosrun", "learning_topic", "07follower_ground.py"],
                                    env=os.environ | {"ROS_MASTER_URI": uri})
        stands = f"{MOMENT}.includes('image {log.image_at(1.5)}/')"
        until = time.monotonic() + LIMIT
        while page.evaluate(stands):
            assert time.monotonic() < until
            page.evaluate("document.querySelector('#drive-on').click()")
            time.sleep(1.0)
        page.wait_for(f"{MOMENT}.startsWith('beyond the run, ')", LIMIT)
        drag_to(page, 1.0)
        wait_for_image(page, log.image_at(1.0))
        assert page.errors == []
    finally:
        replay.end()
        if follower is not None:
            follower.terminate()
            follower.wait(60)


def test_a_page_without_control_shows_where_the_world_is_and_says_what_to_type(browser, tmp_path):
    path = drive("course", 3, tmp_path / "run", 3)
    log = read_run_log(path)
    replay = Replay("--run", path, "--at", "2.0", "--out", tmp_path / "replay")
    try:
        url = re.search(r"http://\S+", replay.wait_for("the page in the browser: "))[0]
        page = browser.open(url)
        wait_for_image(page, log.image_at(2.0))
        assert page.evaluate("['image-before', 'image-next', 'drive-on'].every("
                             "(id) => document.getElementById(id).hidden)")
        drag_to(page, 1.5)
        assert page.evaluate("document.querySelector('#moment-said').textContent") == (
            f"This page may only look: type image:{log.image_at(1.5)} where make replay runs, or "
            "start that with CONTROL=1.")
        wait_for_image(page, log.image_at(2.0))
        replay.type(f"image:{log.image_at(1.5)}")
        wait_for_image(page, log.image_at(1.5))
        assert page.errors == []
    finally:
        replay.end()


def test_in_a_run_that_goes_on_it_says_what_to_type(browser, tmp_path):
    """And that brings another world to that image, while the run goes on."""
    lines = []
    run = subprocess.Popen(
        [sys.executable, Path(__file__).parent.parent / "scripts/course_run.py", "--fast",
         "--no-video", "--any-port", "--camera", "320x240", "--duration", "900",
         "--follower", "07follower_ground.py",
         "--launch-arg", "real_time_factor:=1", "--out", tmp_path / "run"], text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"}, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT)
    threading.Thread(target=lambda: lines.extend(run.stdout), daemon=True).start()
    viewer = replay = None
    try:
        until = time.monotonic() + LIMIT
        while not (uri := re.search(r"ROS_MASTER_URI=([^;\s]+)", "".join(lines))):
            assert time.monotonic() < until and run.poll() is None, lines
            time.sleep(0.1)
        viewer = subprocess.Popen(
            ["rosrun", "sim_viewer", "sim_viewer", "_port:=18271"], text=True,
            env=os.environ | {"ROS_MASTER_URI": uri[1]}, stdout=subprocess.PIPE)
        url = next(found[0] for line in viewer.stdout
                   if (found := re.search(r"http://\S+", line)))
        page = browser.open(url)
        page.wait_for("document.querySelector('#moment')?.max > 3", LIMIT)
        assert page.evaluate("document.querySelector('#drive-on').hidden")
        drag_to(page, 1.2)
        command = page.wait_for("document.querySelector('#moment-back code')?.textContent")
        asked = re.fullmatch(r"make replay RUN=(\S+) AT=(image:\d+)", command)
        assert asked[1] == str(tmp_path / "run")
        replay = Replay("--run", asked[1], "--at", asked[2], "--once",
                        "--out", tmp_path / "replay")
        replay.wait_for(f"{asked[2].replace(':', ' ')} of ")
        assert run.poll() is None
        page.evaluate("document.querySelector('#to-now').click()")
        page.wait_for("document.querySelector('#moment').value > 3")
        assert page.errors == []
    finally:
        if replay is not None:
            replay.end()
        for process in filter(None, (viewer, run)):
            process.terminate()
            process.wait(60)
