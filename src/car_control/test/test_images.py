"""Messages of a camera that are pictures, and those that are none."""

import pytest
import rospy
from car_control.images import picture_of
from sensor_msgs.msg import Image


def message(encoding="bgr8", width=4, height=2, length=24):
    return Image(encoding=encoding, width=width, height=height, step=3 * width, data=bytes(length))


def test_a_picture_is_bgr():
    sent = message("rgb8")
    sent.data = bytes(range(24))
    assert picture_of(sent)[0, 1].tolist() == [5, 4, 3]


@pytest.mark.parametrize("sent, said", [
    (message(length=7), "buffer is too small"), (message("nonsense"), "[nonsense]"),
    (message("32FC1", length=32), "[32FC1] is not a color format"), (message(""), "encoding []"),
    (message(width=0, length=0), "it has no pixels"), (message("mono8", 0, 0, 0), "empty()"),
    (message(width=2**32 - 1, height=2**32 - 1), "too big")])
def test_a_message_that_is_no_picture_is_one_line(monkeypatch, sent, said):
    lines = []
    monkeypatch.setattr(rospy, "logerr_throttle", lambda _, line: lines.append(line))
    assert picture_of(sent) is None
    (line,) = lines
    assert line.startswith("an image that cannot be used: ") and said in line and "\n" not in line
