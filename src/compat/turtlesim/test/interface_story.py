#!/usr/bin/env python3
"""turtlesim_node as draw_square uses it; its topics, services, parameters and log lines."""

import math
import re
import sys
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Twist
from pond_watch import LIMIT, LogLines, Topic, service_names, start_node, wait_until
from sensor_msgs.msg import Image
from std_srvs.srv import Empty
from turtlesim.msg import Color, Pose
from turtlesim.srv import Kill, SetPen, Spawn, TeleportAbsolute, TeleportRelative

CLOSED_WITHIN = 0.02  # m
GOAL = re.compile(r"New goal \[(\S+) (\S+), (\S+)\]")
ROUND_LIMIT = 90.0  # s; one round takes 29


class DrawSquareStory(unittest.TestCase):
    """draw_square resets the pond and closes its square."""

    def test_it_resets_and_drives_round(self):
        log, pose = LogLines(), Topic("/turtle1/pose", Pose)
        rospy.wait_for_service("/turtle1/teleport_absolute", 60.0)
        rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)(1, 1, 1)
        node = start_node("draw_square")
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        log.wait_for_line("Resetting turtlesim.")
        start = pose.next()[0]
        self.assertAlmostEqual(start.x, 5.544445, places=5)

        def goals():
            found = [GOAL.fullmatch(line.msg) for line in log.messages]
            return [tuple(map(float, match.groups())) for match in found if match]

        wait_until(lambda: len(goals()) >= 9, "four sides and four turns", ROUND_LIMIT)
        for i, (x, y) in enumerate([(2, 0), (2, 2), (0, 2), (0, 0)]):
            corner = goals()[2 * i]
            self.assertLess(math.dist(corner[:2], (start.x + x, start.y + y)), 1e-3)
        home = goals()[7]  # the turn at the end of the fourth side begins where the turtle stands
        self.assertLess(math.dist(home[:2], (start.x, start.y)), CLOSED_WITHIN)
        self.assertTrue(any(line.msg == "Reached goal" for line in log.messages))
        self.assertEqual(max(p.linear_velocity for p in pose.messages), 1.0)
        self.assertAlmostEqual(max(p.angular_velocity for p in pose.messages), 0.4, places=6)


MIDDLE = 5.544444561004639  # as `rostopic echo` prints upstream's
WORLD = 499 / 45
PER_TURTLE = {"set_pen": SetPen, "teleport_absolute": TeleportAbsolute,
              "teleport_relative": TeleportRelative}


def service(name, kind):
    rospy.wait_for_service(name, LIMIT)
    return rospy.ServiceProxy(name, kind)


def topics_of(turtle):
    """{topic: type} of all that begins with the turtle's name, published or subscribed to."""
    state = rosgraph.Master("/interface_story").getSystemState()
    names = {name for part in state[:2] for name, nodes in part if "/turtlesim" in nodes}
    return {name for name in names if name.startswith(f"/{turtle}/")}


class InterfaceStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.log = LogLines()
        cls.pose, cls.color = Topic("/turtle1/pose", Pose), Topic("/turtle1/color_sensor", Color)
        cls.command = rospy.Publisher("/turtle1/cmd_vel", Twist, queue_size=1)
        cls.reset, cls.clear = service("/reset", Empty), service("/clear", Empty)
        cls.spawn, cls.kill = service("/spawn", Spawn), service("/kill", Kill)
        wait_until(lambda: cls.command.get_num_connections(), "the command's connection")
        wait_until(lambda: cls.log.subscriber.get_num_connections() >= 2, "the log's connections")

    def setUp(self):
        rospy.set_param("/turtlesim/background_r", 69)
        self.drive()
        self.reset()
        self.pose.forget()
        self.log.forget()

    def drive(self, forward=0.0, left=0.0, turn=0.0):
        message = Twist()
        message.linear.x, message.linear.y, message.angular.z = forward, left, turn
        self.command.publish(message)

    def assert_pose(self, pose, x, y, theta):
        self.assertAlmostEqual(pose.x, x, delta=1e-5)
        self.assertAlmostEqual(pose.y, y, delta=1e-5)
        self.assertAlmostEqual(pose.theta, theta, delta=1e-5)

    def assert_refused(self, text, function, *arguments):
        with self.assertRaisesRegex(rospy.ServiceException, text):
            function(*arguments)

    def test_turtle1_stands_in_the_middle(self):
        pose = self.pose.next()[0]
        self.assertEqual((pose.x, pose.y, pose.theta), (MIDDLE, MIDDLE, 0.0))
        self.assertEqual((pose.linear_velocity, pose.angular_velocity), (0.0, 0.0))

    def test_services_are_in_the_public_namespace(self):
        names = {"/clear", "/reset", "/spawn", "/kill"} | {f"/turtle1/{n}" for n in PER_TURTLE}
        mine = {name for name in service_names()
                if rosgraph.Master("/x").lookupService(name)
                == rosgraph.Master("/x").lookupService("/clear")}
        loggers = {"/turtlesim/get_loggers", "/turtlesim/set_logger_level"}
        self.assertEqual(mine, names | loggers)

    def test_topics_and_types(self):
        self.assertEqual(topics_of("turtle1"),
                         {f"/turtle1/{name}" for name in ("cmd_vel", "pose", "color_sensor")})
        types = dict(rosgraph.Master("/x").getTopicTypes())
        self.assertEqual(types["/turtle1/cmd_vel"], "geometry_msgs/Twist")
        self.assertEqual(types["/turtle1/pose"], "turtlesim/Pose")
        self.assertEqual(types["/turtle1/color_sensor"], "turtlesim/Color")

    def test_background_parameters_are_declared_and_those_given_kept(self):
        values = rospy.get_param("/turtlesim")
        self.assertEqual({name: values[f"background_{name}"] for name in "gb"},
                         {"g": 100, "b": 255})
        self.assertEqual(self.color.next()[0], Color(69, 100, 255))

    def test_background_changes_with_clear_and_not_before(self):
        rospy.set_param("/turtlesim/background_r", 200)
        self.assertEqual(self.color.next()[0].r, 69)
        self.clear()
        self.assertEqual(self.color.next()[0].r, 200)
        self.log.wait_for_line("Clearing turtlesim.", level=2)
        rospy.set_param("/turtlesim/background_r", 10)
        self.reset()
        self.assertEqual(self.color.next()[0].r, 10)
        self.log.wait_for_line("Resetting turtlesim.", level=2)

    def test_a_background_that_is_no_colour_is_said_and_not_used(self):
        rospy.set_param("/turtlesim/background_r", "red")
        self.clear()
        self.log.wait_for_line("parameter /turtlesim/background_r must be a whole number from 0 "
                               "to 255, not 'red': 69 is used")
        self.assertEqual(self.color.next()[0].r, 69)

    def test_a_command_moves_by_a_fixed_step_for_one_second(self):
        self.drive(1.0)
        first = self.pose.wait_for(lambda pose: pose.linear_velocity == 1.0, "moving")
        last = self.pose.wait_for(lambda p: p.x > first.x and p.linear_velocity == 0, "standing")
        steps = (last.x - MIDDLE) / 0.016
        self.assertAlmostEqual(steps, round(steps), delta=0.001)
        self.assertLess(last.x - MIDDLE, 1.04)  # a second of ticks, and one or two more
        self.assertEqual(last.y, MIDDLE)

    def test_linear_y_moves_sideways_and_the_speed_is_a_magnitude(self):
        self.drive(-0.3, 0.4)
        pose = self.pose.wait_for(lambda pose: pose.linear_velocity > 0, "moving")
        self.assertAlmostEqual(pose.linear_velocity, 0.5, places=6)
        self.assertLess(pose.x, MIDDLE)
        self.assertGreater(pose.y, MIDDLE)

    def test_the_wall_is_said_with_y_from_the_top(self):
        service("/turtle1/teleport_absolute", TeleportAbsolute)(5.0, 11.0, math.pi / 2)
        self.drive(10.0)
        line = self.log.wait_for(lambda line: line.msg.startswith("Oh no!"), "the wall")
        self.assertEqual(line.level, 4)
        self.assertRegex(line.msg, r"^Oh no! I hit the wall! "
                                   r"\(Clamping from \[x=5\.000000, y=-0\.0\d{5}\]\)$")
        pose = self.pose.wait_for(lambda pose: pose.y > 11.08, "the wall reached")
        self.assert_pose(pose, 5.0, WORLD, math.pi / 2)
        self.assertEqual(pose.linear_velocity, 10.0)

    def test_teleports(self):
        service("/turtle1/teleport_absolute", TeleportAbsolute)(2.0, 3.0, 0.5)
        self.assert_pose(self.pose.next()[0], 2.0, 3.0, 0.5)
        service("/turtle1/teleport_relative", TeleportRelative)(1.0, math.pi / 2 - 0.5)
        self.assert_pose(self.pose.next()[0], 2.0, 4.0, math.pi / 2)
        self.assert_refused("finite", service("/turtle1/teleport_relative", TeleportRelative),
                            math.nan, 0.0)

    def test_the_pen_draws_what_the_sensor_sees(self):
        set_pen = service("/turtle1/set_pen", SetPen)
        jump = service("/turtle1/teleport_absolute", TeleportAbsolute)
        set_pen(255, 1, 2, 5, 0)
        jump(8.0, MIDDLE, 0.0)
        set_pen(0, 0, 0, 0, 1)
        jump(7.0, MIDDLE, 0.0)
        self.assertEqual(self.color.next()[0], Color(255, 1, 2))
        jump(7.0, 3.0, 0.0)
        self.assertEqual(self.color.next()[0], Color(69, 100, 255))
        self.clear()
        jump(7.0, MIDDLE, 0.0)
        self.assertEqual(self.color.next()[0], Color(69, 100, 255))

    def test_spawn_and_kill(self):
        self.assertEqual(self.spawn(2, 2, 0.5, "").name, "turtle2")
        self.log.wait_for_line("Spawning turtle [turtle2] at x=[2.000000], y=[2.000000], "
                               "theta=[0.500000]", level=2)
        self.assertEqual(self.spawn(2, 2, 0, "leo").name, "leo")
        leo = rospy.wait_for_message("/leo/pose", Pose, LIMIT)
        self.assert_pose(leo, 2, 2, 0)
        self.kill("leo")
        self.assertEqual(topics_of("leo"), set())
        self.assertFalse([name for name in service_names() if name.startswith("/leo/")])

    def test_spawn_refuses(self):
        self.assert_refused(r"A turtle named \[turtle1\] already exists",
                            self.spawn, 1, 1, 0, "turtle1")
        self.log.wait_for_line("A turtle named [turtle1] already exists", level=8)
        self.assert_refused("cannot be a turtle's name", self.spawn, 1, 1, 0, "my turtle")
        self.assert_refused("finite", self.spawn, math.inf, 1, 0, "")

    def test_kill_refuses(self):
        text = "Tried to kill turtle [nobody], which does not exist"
        self.assert_refused("nobody", self.kill, "nobody")
        self.log.wait_for_line(text, level=8)

    def test_reset_takes_turtles_lines_and_speed_away_and_turtle1_goes_on(self):
        self.spawn(2, 2, 0, "")
        self.drive(2.0)
        self.pose.wait_for(lambda pose: pose.x > MIDDLE + 0.3, "driving")
        self.reset()
        pose = self.pose.next()[0]
        self.assertEqual((pose.x, pose.y, pose.linear_velocity), (MIDDLE, MIDDLE, 0.0))
        self.assertEqual(topics_of("turtle2"), set())
        self.log.wait_for_line("Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], "
                               "theta=[0.000000]", level=2)
        self.drive(2.0)
        self.pose.wait_for(lambda pose: pose.x > MIDDLE + 0.3, "driving again")
        self.assertEqual(self.spawn(2, 2, 0, "").name, "turtle2")

    def test_a_turtle_that_was_killed_can_come_again(self):
        self.kill("turtle1")
        self.pose.forget()
        self.spawn(3, 3, 0, "turtle1")
        self.pose.wait_for(lambda pose: pose.x == 3.0, "the new turtle1")
        wait_until(lambda: self.command.get_num_connections(), "the command's connection")
        self.drive(1.0)
        self.pose.wait_for(lambda pose: pose.x > 3.1, "driving")

    def test_a_command_that_is_no_number_is_not_obeyed(self):
        self.drive(math.nan)
        self.log.wait_for(lambda line: "not finite" in line.msg, "a warning")
        self.assertEqual(self.pose.next()[0].x, MIDDLE)

    def test_without_a_screen_the_picture_is_a_topic(self):
        image = Topic("/turtlesim/image", Image).next()[0]
        self.assertEqual((image.width, image.height, image.encoding, image.step),
                         (500, 500, "rgb8", 1500))
        pixels = np.frombuffer(image.data, np.uint8).reshape(500, 500, 3)
        self.assertEqual(tuple(pixels[0, 0]), (69, 100, 255))
        self.assertGreater(np.ptp(pixels[225:275, 225:275], axis=(0, 1)).max(), 30)


if __name__ == "__main__":
    rospy.init_node("interface_story")
    rostest.rosrun("turtlesim", "interface_story", "__main__", sys.argv)
