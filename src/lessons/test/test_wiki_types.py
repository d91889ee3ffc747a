"""The types of the wiki's tutorial packages have upstream's MD5 sums."""

import pytest
import roslib.message

SUMS = {
    "rospy_tutorials/Floats": "420cd38b6b071cd49f2970c3e2cee511",
    "rospy_tutorials/HeaderString": "c99a9440709e4d4a9716d55b8270d5e7",
    "rospy_tutorials/AddTwoInts": "6a2e34150c00229791cc89ff309fff21",
    "rospy_tutorials/BadTwoInts": "60962375a49bd6746d7c85dff75ebb9c",
    "roscpp_tutorials/TwoInts": "6a2e34150c00229791cc89ff309fff21",
    "actionlib_tutorials/FibonacciAction": "f59df5767bf7634684781c92598b2406",
    "actionlib_tutorials/AveragingAction": "628678f2b4fa6a5951746a4a2d39e716",
    "turtle_actionlib/ShapeAction": "d73b17d6237a925511f5d7727a1dc903",
    "turtle_actionlib/Velocity": "9d5c2dcd348ac8f76ce2a4307bd63a13",
}


@pytest.mark.parametrize("name", SUMS)
def test_md5_sum(name):
    made = roslib.message.get_message_class(name) or roslib.message.get_service_class(name)
    assert made._md5sum == SUMS[name]
