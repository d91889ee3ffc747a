"""The node of both trackers without a master: what it sends, and that nothing follows its end."""

from unittest.mock import MagicMock

import pytest
from ai_robot_tracking import tracker_node
from drawn_room import room
from sensor_msgs.msg import Image


@pytest.fixture
def rospy(monkeypatch):
    fake = MagicMock()
    fake.get_time.return_value = 100.0
    fake.is_shutdown.return_value = False
    monkeypatch.setattr(tracker_node, "rospy", fake)
    return fake


def test_a_picture_gives_a_command_but_not_after_the_end(rospy):
    node = tracker_node.TrackerNode(0.5, lambda _picture, _time: (0.2, 0.1), lambda *_: None)
    node._commands, node._annotated = MagicMock(), MagicMock()
    node._annotated.get_num_connections.return_value = 0
    sent = node._commands.publish.call_args_list
    pixels = room()
    message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding="bgr8",
                    step=3 * pixels.shape[1], data=pixels.tobytes())
    node._take_image(message)
    assert [call.args[0].linear.x for call in sent] == [0.2]
    rospy.is_shutdown.return_value = True
    node._end()
    node._take_image(message)
    assert [call.args[0].linear.x for call in sent] == [0.2, 0.0]
