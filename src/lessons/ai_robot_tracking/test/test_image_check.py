"""The trackers: images that must not be driven by, what the node sends, nothing after its end."""

from unittest.mock import MagicMock

import numpy as np
import pytest
from ai_robot_tracking import tracker_node
from ai_robot_tracking.red_target import Colour, all_red
from ai_robot_tracking.tracker_node import BadImage, ImageCheck, decode
from drawn_room import cylinder, room
from sensor_msgs.msg import Image

PICTURE = cylinder(1.2, 0.0)
ROWS, COLUMNS = PICTURE.shape[:2]


def test_colours_come_as_bgr_whatever_was_sent():
    step = COLUMNS * 3
    sent = {"bgr8": PICTURE, "rgb8": PICTURE[:, :, ::-1]}
    for encoding, picture in sent.items():
        assert (decode(encoding, COLUMNS, ROWS, step, picture.tobytes()) == PICTURE).all()
    four = np.dstack([PICTURE, np.full((ROWS, COLUMNS), 255, np.uint8)])
    assert (decode("bgra8", COLUMNS, ROWS, 4 * COLUMNS, four.tobytes()) == PICTURE).all()


def test_rows_may_be_padded():
    padded = np.zeros((ROWS, COLUMNS * 3 + 8), np.uint8)
    padded[:, :-8] = PICTURE.reshape(ROWS, -1)
    assert (decode("bgr8", COLUMNS, ROWS, padded.shape[1], padded.tobytes()) == PICTURE).all()


@pytest.mark.parametrize(("encoding", "width", "step", "data", "said"), [
    ("mono8", COLUMNS, COLUMNS, b"\1" * (ROWS * COLUMNS), "mono8"),
    ("nonsense", COLUMNS, COLUMNS * 3, PICTURE.tobytes(), "nonsense"),
    ("bgr8", COLUMNS, COLUMNS, b"\1" * (ROWS * COLUMNS), "step"),
    ("bgr8", COLUMNS, COLUMNS * 3, PICTURE.tobytes()[:-1], "bytes"),
    ("bgr8", 0, 0, b"", "empty"),
])
def test_sizes_that_do_not_fit(encoding, width, step, data, said):
    with pytest.raises(BadImage, match=said):
        decode(encoding, width, ROWS, step, data)


def test_blank():
    check = ImageCheck()
    with pytest.raises(BadImage, match="blank"):
        check.look(np.full((ROWS, COLUMNS, 3), 90, np.uint8), 0.0, moving=False)
    check.look(room(), 0.1, moving=False)


def test_frozen_after_the_clock_was_set_back():
    check = ImageCheck()
    check.look(PICTURE, 100.0, moving=True)
    check.look(PICTURE.copy(), 3.0, moving=True)
    with pytest.raises(BadImage, match="frozen"):
        check.look(PICTURE.copy(), 3.6, moving=True)


def test_frozen_only_if_the_robot_should_move():
    check = ImageCheck()
    for tick in range(40):  # standing sees the same, for ever
        check.look(PICTURE.copy(), tick / 30, moving=False)
    since = 40 / 30
    for tick in range(14):
        check.look(PICTURE.copy(), since + tick / 30, moving=True)
    with pytest.raises(BadImage, match="frozen"):
        check.look(PICTURE.copy(), since + 0.6, moving=True)
    with pytest.raises(BadImage, match="frozen"):  # it stands now; that proves nothing
        check.look(PICTURE.copy(), since + 2.0, moving=False)
    check.look(room(), since + 2.1, moving=False)
    check.look(PICTURE, since + 2.2, moving=True)


@pytest.fixture
def rospy(monkeypatch):
    fake = MagicMock()
    fake.get_time.return_value = 100.0
    fake.is_shutdown.return_value = False
    monkeypatch.setattr(tracker_node, "rospy", fake)
    return fake


@pytest.fixture
def node(rospy):
    node = tracker_node.TrackerNode(0.5, lambda _picture, _time: (0.2, 0.1), lambda *_: None,
                                    lambda picture: all_red(picture, Colour(0, 10, 100, 100)))
    node._commands, node._annotated = MagicMock(), MagicMock()
    node._annotated.get_num_connections.return_value = 0
    return node


def show(node, pixels):
    """Give the node an image (rows, columns, 3), BGR; all speeds sent so far, m/s."""
    node._take_image(Image(height=pixels.shape[0], width=pixels.shape[1], encoding="bgr8",
                           step=3 * pixels.shape[1], data=pixels.tobytes()))
    return [call.args[0].linear.x for call in node._commands.publish.call_args_list]


def test_a_picture_gives_a_command_but_not_after_the_end(rospy, node):
    assert show(node, room()) == [0.2]
    rospy.is_shutdown.return_value = True
    node._end()
    assert show(node, room()) == [0.2, 0.0]


def test_at_the_target_it_says_once_that_it_has_arrived(rospy, node):
    red = np.full((ROWS, COLUMNS, 3), (10, 10, 200), np.uint8)
    for _ in range(2):
        show(node, red)
    assert show(node, red) == [0.0, 0.0, 0.0]
    assert [call.args[0] for call in rospy.loginfo.call_args_list] == [
        "arrived: the target fills the image on %s; standing"]
    rospy.logwarn_throttle.assert_not_called()
    show(node, np.full_like(red, 90))
    assert "bad image" in rospy.logwarn_throttle.call_args.args[1]
