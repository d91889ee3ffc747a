"""rqt's tools by all the ways that pages and launch files start them."""

import re
import shutil
import signal
import subprocess
from pathlib import Path

import pytest
from roslib.packages import find_node
from rqt_pages.stand_in import COMMANDS, TABS, line_for

pytestmark = pytest.mark.processes

SRC = Path(__file__).resolve().parents[3]
TOOLS = sorted(path.parent.name for path in SRC.glob("compat/names/rqt_*/package.xml"))
VIEWER = SRC / "sim/sim_viewer/README.md"


def test_there_are_fourteen():
    assert len(TOOLS) == 14


@pytest.mark.parametrize("tool", TOOLS)
def test_each_is_found_as_node_and_on_the_path(tool):
    assert tool == "rqt_gui" or tool in {*TABS, *COMMANDS}
    assert find_node(tool, tool)
    assert shutil.which(tool)


@pytest.mark.parametrize("tab", sorted(set(TABS.values())))
def test_the_tab_is_there(tab):
    text = re.sub(r"\[(\w+)\]\([^)]*\)", r"\1", VIEWER.read_text(encoding="utf-8"))  # links
    rows = re.findall(r"^\| ([^|]+) \|", text, re.MULTILINE)
    assert tab in ", ".join(rows).replace(" ", "").split(",")


def test_typed_it_says_one_line_and_ends():
    ended = subprocess.run(["rqt_graph"], capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr == ("rqt_graph has no window here; the page in the browser does its work, "
                            "tab Graph. Type: roslaunch sim_viewer viewer.launch\n")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_in_a_launch_file_it_stays_until_it_is_ended(number):
    node = find_node("rqt_gui", "rqt_gui")[0]
    process = subprocess.Popen([node, "__name:=rqt"], stderr=subprocess.PIPE, text=True)
    try:
        assert "has no window here" in process.stderr.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(0.5)
        process.send_signal(number)
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        process.stderr.close()


@pytest.mark.parametrize("arguments, said", [
    (["-s", "rqt_plot"], "tab Plot"), (["--standalone", "rqt_image_view/ImageView"], "tab Cameras"),
    (["-s", "rqt_reconfigure"], "Type: rosrun dynamic_reconfigure dynparam set"),
    ([], "rqt has no window here; the page in the browser does its work. Type: roslaunch")])
def test_rqt_with_a_plugin_named(arguments, said):
    assert said in line_for("rqt", arguments)
