#!/usr/bin/env python3
"""A second simulator on a master ends with one line; the first one notices nothing."""

import re
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties
from gzserver_process import LIMIT, NODE, Gzserver, wait_until

LINE = re.compile(r"A simulator runs already on this master \(world camera_robot, started \d+ "
                  r"(s|min) ago\)(\. End it with Ctrl-C in its terminal|, without a terminal\. "
                  r"End it and what was started with it: kill [\d ]+), then type this again\.")
SERVER = ("rosrun", "gazebo_ros", "gzserver")
FIRST_ROBOT, SECOND_ROBOT = "the first's", "the second's"
SECOND_LAUNCH = f"""<launch>
  <param name="robot_description" value="{SECOND_ROBOT}"/>
  <group NS>
    <include file="$(find gazebo_ros)/launch/empty_world.launch">
      <arg name="gui" value="false"/>
      <arg name="server_required" value="true"/>
    </include>
  </group>
</launch>"""


def run_to_its_end(*command):
    """What a program prints that is to end with exit code 1."""
    done = subprocess.run(command, text=True, timeout=LIMIT,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 1, done.stdout
    return done.stdout


def assert_unharmed(server, uri):
    assert rosgraph.Master("/test").lookupNode(NODE) == uri
    assert "robot" in server.call("get_world_properties", GetWorldProperties).model_names
    assert server.process.poll() is None
    assert "shutdown request" not in server.output()


class SecondBesideOneThatRuns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.first = Gzserver()
        cls.addClassCleanup(cls.first.end, signal.SIGKILL)
        cls.first.wait_until_ready()
        cls.uri = rosgraph.Master("/test").lookupNode(NODE)

    def launch(self, attribute=""):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / "second.launch"
        path.write_text(SECOND_LAUNCH.replace("NS", attribute))
        return "roslaunch", str(path)

    def test_a_second_server_ends_with_one_line(self):
        done = run_to_its_end(*SERVER)
        self.assertRegex(done, rf"^{LINE.pattern}\n$")
        assert_unharmed(self.first, self.uri)

    def test_a_second_launch_ends_before_it_sets_or_starts_anything(self):
        rospy.set_param("/robot_description", FIRST_ROBOT)
        done = run_to_its_end(*self.launch())
        # Last on a terminal; in a pipe what roslaunch itself printed may follow.
        [said] = [line for line in done.splitlines() if "runs already" in line]
        self.assertRegex(said, rf"^{LINE.pattern}$", done)
        for other in ("process[", "RLException", "Traceback"):
            self.assertNotIn(other, done)
        self.assertEqual(rospy.get_param("/robot_description"), FIRST_ROBOT)
        assert_unharmed(self.first, self.uri)

    def test_a_launch_in_another_namespace_runs_beside_it(self):
        with subprocess.Popen(self.launch('ns="two"')) as launched:
            try:
                rospy.wait_for_service(f"/two{NODE}/get_world_properties", LIMIT)
                assert_unharmed(self.first, self.uri)
            finally:
                launched.send_signal(signal.SIGINT)

    def test_one_that_hangs_is_named(self):
        self.first.process.send_signal(signal.SIGSTOP)
        self.addCleanup(self.first.process.send_signal, signal.SIGCONT)
        self.assertIn("does not answer (world camera_robot, started", run_to_its_end(*SERVER))


class SecondAndFirstEndOrBegin(unittest.TestCase):
    def start(self):
        server = Gzserver()
        self.addCleanup(server.end, signal.SIGKILL)
        return server

    def test_one_that_was_killed_does_not_block_the_next(self):
        first = self.start().wait_until_ready()
        first.end(signal.SIGKILL)
        self.assertTrue(rosgraph.Master("/test").lookupNode(NODE))  # still registered
        self.start().wait_until_ready()

    def test_of_two_that_start_at_once_one_runs(self):
        servers = [self.start(), self.start()]
        wait_until(lambda: any(server.process.poll() is not None for server in servers),
                   "the end of one of them")
        loser, winner = sorted(servers, key=lambda server: server.process.poll() is None)
        self.assertEqual(loser.process.returncode, 1)
        self.assertIn("A simulator runs already on this master", loser.output())
        assert_unharmed(winner.wait_until_ready(), rosgraph.Master("/test").lookupNode(NODE))


if __name__ == "__main__":
    rospy.init_node("second_contract", disable_rostime=True)
    rostest.rosrun("bullet_sim_ros", "second", "__main__")
