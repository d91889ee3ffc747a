"""Messages of arrays are the same on the wire, and their arrays are not copied."""

import io
import struct

import numpy as np
import pytest
import rospy.topics
from rospy.exceptions import ROSSerializationException
from rospy.msg import serialize_message
from std_msgs.msg import String

from bullet_sim_ros.array_messages import ArrayImage, ArrayPointCloud2
from bullet_sim_ros.rospy_patches import MessageBuffer, PromptConnection, send_promptly

PIXELS = np.arange(45, dtype=np.uint8).reshape(3, 5, 3)
POINTS = np.arange(60, dtype=np.float32).reshape(3, 5, 4)
MESSAGES = {
    "image": lambda: ArrayImage(PIXELS, encoding="rgb8"),
    "points": lambda: ArrayPointCloud2(POINTS, "xyz_"),
    "no points": lambda: ArrayPointCloud2(POINTS[:, :0], "xyz_"),
    "text": lambda: String("hello")}


def written(buff, message):
    """As rospy's Publisher does it; the buffer is used again."""
    serialize_message(buff, 7, message)
    value, size = buff.getvalue(), buff.tell()
    buff.seek(0)
    buff.truncate(0)
    return value, size


@pytest.mark.parametrize("names", [list(MESSAGES), list(MESSAGES)[::-1]])
def test_the_same_bytes_as_rospys_own_buffer_writes(names):
    ours, rospys = MessageBuffer(), io.BytesIO()
    for name in names:
        value, size = written(ours, MESSAGES[name]())
        assert (b"".join(value) if isinstance(value, list) else value, size) == written(
            rospys, MESSAGES[name]())


def test_after_a_message_that_failed_it_goes_on_as_rospys_does():
    """An array was in it already; rospy does not take back what was written."""
    class Broken(ArrayImage):
        def serialize(self, buff):
            super().serialize(buff)
            raise struct.error("no number")

    values = []
    for buff in (MessageBuffer(), io.BytesIO()):
        with pytest.raises(ROSSerializationException):
            serialize_message(buff, 7, Broken(PIXELS, encoding="rgb8"))
        value, size = written(buff, MESSAGES["image"]())
        values.append((b"".join(value), size) if isinstance(value, list) else (value, size))
        assert written(buff, MESSAGES["text"]())[0] == b"\x09\0\0\0\x05\0\0\0hello"
    assert values[0] == values[1]


@pytest.mark.parametrize("name, array", [("image", PIXELS), ("points", POINTS)])
def test_the_array_itself_is_sent(name, array):
    pieces, _ = written(MessageBuffer(), MESSAGES[name]())
    assert any(np.shares_memory(np.frombuffer(piece, np.uint8), array) for piece in pieces)


def test_rospys_publishers_have_our_connections_and_buffers(monkeypatch):
    for name in ("QueuedConnection", "BytesIO"):
        monkeypatch.setattr(rospy.topics, name, getattr(rospy.topics, name))  # back afterwards
    send_promptly()
    publisher = rospy.topics._PublisherImpl("/x", String)
    assert isinstance(publisher.buff, MessageBuffer)
    assert rospy.topics.QueuedConnection is PromptConnection
