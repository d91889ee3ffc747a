"""The node without a master: its parameters, a clock that is set back, pictures at the end."""

import importlib.util
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest
from drawn_lane import draw
from lane_keeping.lane_keeper import LaneKeeper
from lane_keeping.settings import load_settings
from node_basics.settings import SettingsError
from sensor_msgs.msg import Image

PACKAGE = Path(__file__).parents[1]
SETTINGS = load_settings(PACKAGE / "config" / "lane_keeping.yaml")


@pytest.fixture
def script():
    spec = importlib.util.spec_from_file_location(
        "lane_keeping_node", PACKAGE / "scripts" / "lane_keeping_node.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.rospy = MagicMock()
    module.rospy.get_time.return_value = 100.0
    module.rospy.is_shutdown.return_value = False
    return module


@pytest.fixture
def node(script):
    node = script.LaneKeeping(SETTINGS, window=False)
    node.commands, node.pictures = MagicMock(), MagicMock()
    node.pictures.get_num_connections.return_value = 0
    return node


def picture():
    pixels = np.ascontiguousarray(draw(SETTINGS))
    message = Image(height=480, width=640, encoding="bgr8", step=1920, data=pixels.tobytes())
    message.header.stamp.secs = 100
    return message


def speeds(node):
    return [call.args[0].linear.x for call in node.commands.publish.call_args_list]


def test_a_picture_gives_a_command_but_not_after_the_end(script, node):
    node.take_image(picture())
    assert len(speeds(node)) == 1 and speeds(node)[0] > 0
    script.rospy.is_shutdown.return_value = True
    node.take_image(picture())
    assert len(speeds(node)) == 1


@pytest.mark.parametrize("encoding, order", [
    ("bgr8", [0, 1, 2]), ("rgb8", [2, 1, 0]), ("bgra8", [0, 1, 2, 2]), ("rgba8", [2, 1, 0, 2]),
    ("mono8", [1]),
])
def test_rows_may_be_padded(node, encoding, order):
    pixels = draw(SETTINGS)
    if encoding == "mono8":
        pixels = np.repeat(pixels[..., 1:2], 3, axis=2)
    row = 640 * len(order)
    rows = np.full((480, row + 7), 255, np.uint8)
    rows[:, :row] = pixels[..., order].reshape(480, row)
    node.keeper = MagicMock()
    node.keeper.step.return_value = LaneKeeper(SETTINGS).last
    node.take_image(Image(height=480, width=640, encoding=encoding, step=row + 7,
                          data=rows.tobytes()))
    assert np.array_equal(node.keeper.step.call_args.args[0], pixels)


def test_no_pictures_are_noticed_after_the_clock_is_set_back(script, node):
    for now, sent in ((100.2, 0), (3.0, 0), (3.4, 0), (3.6, 1)):
        script.rospy.get_time.return_value = now
        node.check_images(None)
        assert speeds(node) == [0.0] * sent


@pytest.mark.parametrize("given, said", [
    ({"config": 7}, "'config' must be a file, not 7"),
    ({"window": "fasle"}, "'window' must be true or false, not 'fasle'"),
    ({"method": "slidingwindows"}, "'method' must be one of sliding_windows, "),
])
def test_wrong_parameters_are_one_line(script, given, said):
    with pytest.raises(SettingsError, match=r"^the node's parameters: ") as caught:
        script.read_parameters(given)
    assert said in str(caught.value)


def test_parameters_win_over_the_file(script):
    settings, window = script.read_parameters({"method": "skeleton", "window": 0, "config": ""})
    assert (settings.method, window) == ("skeleton", False)
