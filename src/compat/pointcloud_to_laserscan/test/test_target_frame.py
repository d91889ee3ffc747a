"""Points into another frame, by a buffer without topics."""

import numpy as np
import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from pointcloud_to_laserscan.target_frame import TargetFrame
from std_msgs.msg import Header


@pytest.fixture
def base(monkeypatch):
    """The frame `base` at 10 s by the clock; frame `mast` is 1 m above it, turned to the left."""
    monkeypatch.setattr(rospy, "get_time", lambda: 10.0)
    frame = TargetFrame.__new__(TargetFrame)
    frame.name, frame.tolerance = "base", rospy.Duration(0)
    frame.buffer = tf2_ros.Buffer(debug=False)
    mast = TransformStamped(header=Header(frame_id="base"), child_frame_id="mast")
    mast.transform.translation.z = 1.0
    mast.transform.rotation.z = mast.transform.rotation.w = 0.5 ** 0.5
    frame.buffer.set_transform_static(mast, "test")
    return frame


@pytest.mark.parametrize(("source", "expected"), [
    ("mast", [0, 2, 1]), ("/mast", [0, 2, 1]), ("base", [2, 0, 0])])
def test_points_are_turned_into_it(base, source, expected):
    header = Header(frame_id=source, stamp=rospy.Time(10))
    assert base.turned(np.array([[2.0, 0, 0]]), header) == pytest.approx(np.array([expected]))


@pytest.mark.parametrize(("source", "second"), [
    ("other", 10), ("ma\0st", 10), ("mast", 2**32 - 1)])  # the last one, asked of tf2, is SIGABRT
def test_what_cannot_be_looked_up_is_one_exception(base, source, second):
    header = Header(frame_id=source, stamp=rospy.Time(second))
    with pytest.raises(tf2_ros.TransformException) as caught:
        base.turned(np.zeros((1, 3)), header)
    assert "\n" not in str(caught.value)
