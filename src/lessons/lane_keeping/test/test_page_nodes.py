"""The page's nodes without a master, and the commands behind its verbs."""

import ast
import importlib.util
import os
import subprocess
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import cv2
import numpy as np
import pytest
from drawn_lane import draw
from lane_keeping.binarise import line_mask
from lane_keeping.methods import sliding_windows
from lane_keeping.road_view import road_view
from lane_keeping.settings import load_settings
from sensor_msgs.msg import Image

PACKAGE = Path(__file__).parents[1]
SETTINGS = load_settings(PACKAGE / "config" / "page.yaml")


def started(name, node, **parameters):
    spec = importlib.util.spec_from_file_location(name, PACKAGE / "scripts" / f"{name}.py")
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.rospy = MagicMock()
    script.cv2 = SimpleNamespace(**{**vars(cv2), "imshow": MagicMock(), "waitKey": MagicMock()})
    script.rospy.get_param = lambda key, default: parameters.get(key.lstrip("~"), default)
    return script, getattr(script, node)()


def picture(pixels):
    height, width = pixels.shape[:2]
    return Image(height=height, width=width, encoding="bgr8", step=3 * width,
                 data=np.ascontiguousarray(pixels).tobytes())


def commands(node):
    return [(call.args[0].linear.x, call.args[0].angular.z)
            for call in node.velocity_publisher.publish.call_args_list]


def test_the_controller_drives_along_the_lane_and_shows_three_windows():
    script, node = started("visual_motion_controller", "VisualMotionController")
    node.process_and_control(picture(draw(SETTINGS)))
    ((speed, turn),) = commands(node)
    assert speed in (1.0, 0.5) and abs(turn) <= 2.0
    shown = [call.args[0] for call in script.cv2.imshow.call_args_list]
    assert shown == ["ROI", "ROI-II", "Lane Detection"]


@pytest.mark.parametrize("lane", [
    {}, {"beside": 0.1}, {"beside": -0.1, "turned": 0.15}, {"curvature": 0.4}, {"curvature": -0.6},
    {"sides": (1,)}, {"sides": (-1,)}, {"sides": (1,), "curvature": 0.4}], ids=str)
def test_it_drives_as_our_sliding_windows_with_the_pages_numbers(lane):
    pixels = draw(SETTINGS, **lane)
    _, node = started("visual_motion_controller", "VisualMotionController")
    node.process_and_control(picture(pixels))
    ((speed, turn),) = commands(node)
    wanted = sliding_windows.plan(line_mask(pixels, SETTINGS), road_view(SETTINGS, 640, 480),
                                  SETTINGS)
    assert speed == wanted.speed
    assert turn == pytest.approx(wanted.turn, abs=0.05 if "sides" in lane else 1e-6)


@pytest.mark.parametrize("name", ["learning_node", "visual_motion_controller"])
def test_a_page_s_node_is_one_file_without_ours(name):
    tree = ast.parse((PACKAGE / "scripts" / f"{name}.py").read_text(encoding="utf-8"))
    modules = {name.name for node in ast.walk(tree) if isinstance(node, ast.Import)
               for name in node.names}
    modules |= {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert modules <= {"itertools", "time", "cv2", "cv_bridge", "numpy", "rospy",
                       "geometry_msgs.msg", "sensor_msgs.msg"}


@pytest.mark.parametrize("debug_mode", [True, False])
def test_it_stands_without_a_lane_and_in_debug_mode(debug_mode):
    _, node = started("visual_motion_controller", "VisualMotionController", debug_mode=debug_mode)
    pixels = draw(SETTINGS)
    if not debug_mode:
        pixels[:] = 255
        pixels[-1, -1] = 0  # darker than the mean, but only a speck
    node.process_and_control(picture(pixels))
    assert commands(node) == [(0.0, 0.0)]


def test_the_first_node_drives_100_images_ahead_and_60_to_the_left():
    script, node = started("learning_node", "LearningNode")
    for _ in range(161):
        node.take_image(picture(np.zeros((2, 2, 3), np.uint8)))
    assert commands(node) == [(1.0, 0.0)] * 100 + [(0.5, 0.5)] * 60 + [(1.0, 0.0)]
    assert script.cv2.imshow.call_args.args[0] == "img"


@pytest.mark.parametrize(("verb", "command"), [
    ("go", "rostopic pub -1 /cmd_vel geometry_msgs/Twist '{linear: {x: 1.0}}'"),
    ("left", "geometry_msgs/Twist '{linear: {x: 0.5}, angular: {z: 0.5}}'"),
    ("right", "geometry_msgs/Twist '{linear: {x: 0.5}, angular: {z: -0.5}}'"),
    ("stop", "rostopic pub -1 /cmd_vel geometry_msgs/Twist '{}'"),
    ("img", "rosrun rqt_image_view rqt_image_view /camera"),
    ("node", "rosrun lane_keeping visual_motion_controller.py"),
    ("start", "roslaunch lane_keeping start.launch method:=sliding_windows"),
])
def test_the_verbs_are_the_pages(verb, command):
    done = subprocess.run(["make", "-n", "-C", str(PACKAGE), verb], capture_output=True, text=True,
                          check=True)
    assert done.stdout.splitlines()[-2 if "Leaving" in done.stdout else -1].endswith(command)


def test_make_shows_what_a_command_says_and_not_the_command():
    done = subprocess.run(["make", "--no-print-directory", "-C", str(PACKAGE), "bridge"],
                          capture_output=True, text=True, check=True)
    assert done.stdout.startswith("No bridge is needed") and done.stdout.count("\n") == 1


@pytest.mark.parametrize(("screen", "program"), [
    (":0", "rviz"), ("", "rosrun sim_viewer rviz_page")])
def test_without_a_screen_the_browser_shows_what_rviz_would(screen, program):
    done = subprocess.run(["make", "-n", "-C", str(PACKAGE), "rv"], capture_output=True, text=True,
                          env={"PATH": os.defpath, "DISPLAY": screen})
    assert f"; {program} -d {PACKAGE}/config/lane.rviz\n" in done.stdout, done.stderr
