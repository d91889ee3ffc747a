"""Nodes that launch files of older releases start by names that Noetic no longer has."""

import os
import subprocess

import pytest
from roslib.packages import find_node


@pytest.mark.parametrize("name", ["state_publisher", "robot_state_publisher"])
def test_robot_state_publisher_starts_by_both_its_names(name):
    (node,) = find_node("robot_state_publisher", name)
    nowhere = {**os.environ, "ROS_MASTER_URI": "no address"}
    ended = subprocess.run([node], env=nowhere, capture_output=True, text=True, timeout=60,
                           check=False)
    assert "master URI [no address]" in ended.stderr  # it is roscpp that complains
    assert ("deprecated" in ended.stderr) == (name == "state_publisher")
