"""rviz where nothing can be seen, and what it asks rospack."""

import os
import subprocess

import pytest
from rqt_pages.stand_in import window

BLIND = {name: value for name, value in os.environ.items()
         if name not in ("DISPLAY", "WAYLAND_DISPLAY")}


@pytest.mark.parametrize("command", [["rviz"], ["rosrun", "rviz", "rviz"]])
@pytest.mark.parametrize("words, typed", [
    ([], "roslaunch sim_viewer viewer.launch"),
    (["-d", "/a/b.rviz"], "rosrun sim_viewer rviz_page -d /a/b.rviz"),
    (["--display-config=c.rviz"], "rosrun sim_viewer rviz_page -d c.rviz")])
def test_without_a_screen_it_names_the_tab_and_the_command(command, words, typed):
    done = subprocess.run([*command, *words], env=BLIND, capture_output=True, text=True, timeout=60,
                          check=False)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == ("rviz has no window here; the page in the browser does its work, tab "
                           f"RViz. Type: {typed}\n")


@pytest.mark.parametrize("variable", ["DISPLAY", "WAYLAND_DISPLAY"])
def test_with_a_screen_it_is_debians(monkeypatch, variable):
    became = []
    monkeypatch.setenv(variable, ":0")
    monkeypatch.setattr(os, "execv", lambda program, words: became.append([program, *words[1:]]))
    window("rviz", "/usr/bin/rviz", ["-d", "a.rviz"])
    assert became == [["/usr/bin/rviz", "-d", "a.rviz"]]


def test_rospack_knows_the_name_that_rviz_asks_for():
    done = subprocess.run(["rospack", "plugins", "--attrib=ogre_media_path", "media_export"],
                          capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
