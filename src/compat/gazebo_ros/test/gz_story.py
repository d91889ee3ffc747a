#!/usr/bin/env python3
"""gz lists, spawns, moves and deletes models of a running simulator; killall finds that one."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties, GetWorldPropertiesResponse

LIMIT = 60.0  # s
BLOCK = """<sdf version="1.6"><model name="block"><static>true</static><link name="l">
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link></model>
</sdf>"""


def gz(*words, piped="", namespace="/"):
    """Exit code and output, then errors."""
    done = subprocess.run(["gz", *words], capture_output=True, text=True, timeout=LIMIT,
                          check=False, input=piped,
                          env=os.environ | {"ROS_NAMESPACE": namespace})
    return done.returncode, done.stdout, done.stderr


class GzStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/gazebo/get_world_properties", LIMIT)

    def test_a_model_from_its_file_to_its_end(self):
        # conforms: gz, gz/model, gz/world
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "block.sdf")
            path.write_text(BLOCK, encoding="utf-8")
            self.assertEqual(gz("model", "-f", str(path), "-x", "1", "-Y", "0.5")[0], 0)
        self.assertEqual(gz("model", "--list")[:2], (0, "ground_plane\nblock\n"))
        self.assertEqual(gz("model", "-m", "block", "-z", "2"), (0, "", ""))
        said = gz("model", "-m", "block", "-p")[1]
        self.assertEqual([round(float(word), 3) for word in said.split()], [1, 0, 2, 0, 0, 0.5])
        self.assertIn("body_names", gz("model", "-m", "block", "--info")[1])
        self.assertEqual(gz("model", "-m", "block", "-d"), (0, "", ""))
        code, _, said = gz("model", "-m", "block", "-p")
        self.assertEqual((code, said), (1, "gz model: GetModelState: model does not exist\n"))

    def test_ros_namespace_names_a_simulator(self):
        other = rospy.Service("/b/gazebo/get_world_properties", GetWorldProperties,
                              lambda _: GetWorldPropertiesResponse(
                                  model_names=["of_b"], success=True))
        self.addCleanup(other.shutdown)
        with self.assertNoLogs("rospy.internal", "WARNING"):  # by the node that was asked
            self.assertEqual(gz("model", "--list", namespace="b"), (0, "of_b\n", ""))
        self.assertNotIn("of_b", gz("model", "--list")[1])
        self.assertNotIn("of_b", gz("model", "--list", namespace="c")[1])

    def test_the_world_stands_still_and_goes_on(self):
        for word in ("-p1", "-p0", "-r", "-o"):
            self.assertEqual(gz("world", word), (0, "", ""))

    def test_a_paused_world_takes_single_steps(self):
        properties = rospy.ServiceProxy("/gazebo/get_world_properties", GetWorldProperties)
        self.assertEqual(gz("world", "-w", "default", "-p1"), (0, "", ""))
        before = properties().sim_time
        self.assertEqual(gz("world", "-s"), (0, "", ""))
        self.assertEqual(gz("world", "-m", "9"), (0, "", ""))
        self.assertAlmostEqual(properties().sim_time - before, 0.01, places=6)
        self.assertEqual(gz("world", "-p0"), (0, "", ""))

    def test_a_model_comes_through_a_pipe(self):
        self.assertEqual(gz("model", "-s", "-x", "3", piped=BLOCK)[0], 0)
        said = gz("model", "-w", "default", "-m", "block", "-p")[1]
        self.assertEqual(round(float(said.split()[0]), 3), 3)
        self.assertEqual(gz("model", "-m", "block", "-d"), (0, "", ""))
        self.assertEqual(gz("model", "-s", piped="<sdf version='1.6'/>"), (
            1, "", "gz model: what is piped has no <model name=>; type: gz model -s -m NAME\n"))

    def test_topics_are_those_of_ros(self):
        # conforms: gz/topic
        self.assertIn("/clock\n", gz("topic", "-l")[1])
        self.assertIn("Type: rosgraph_msgs/Clock", gz("topic", "-i", "/clock")[1])

    def test_killall_and_pkill_find_the_simulator(self):
        address = rosgraph.Master("/gz_story").lookupNode("/gazebo")
        process = Path("/proc", str(ServerProxy(address).getPid("/gz_story")[2]))
        self.assertEqual((process / "comm").read_text(), "gzserver\n")
        self.assertIn(b"gzserver", (process / "cmdline").read_bytes().split(b"\0"))


if __name__ == "__main__":
    rospy.init_node("gz_story")
    rostest.rosrun("gazebo_ros", "gz_story", GzStory, sys.argv)
