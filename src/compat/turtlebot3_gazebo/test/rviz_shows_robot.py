#!/usr/bin/env python3
"""Rviz under Xvfb: the shipped configurations subscribe, and the pictures show the robot."""

import os
import subprocess
import sys
import time
import unittest

import cv2
import numpy as np
import rosgraph
import rospkg
import rospy
import rostest
from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Vector3, Wrench
from nav_msgs.msg import OccupancyGrid

LIMIT = 60.0  # s, for whatever is waited for
WIDTH, HEIGHT = 1200, 846  # px, of the screen and the window
SAVE = os.environ.get("RVIZ_PICTURES")  # a folder, for people who want to look


def start_screen():
    """Xvfb on a free display; returns it and the display's name."""
    reader, writer = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{WIDTH}x{HEIGHT}x24",
         "-nolisten", "tcp"], pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    with os.fdopen(reader) as answer:
        return screen, f":{answer.readline().strip()}"


def subscriptions(node):
    return {topic for topic, names in rosgraph.Master("/test").getSystemState()[1]
            if node in names}


def wait_until(condition, what, limit=LIMIT):
    end = time.monotonic() + limit
    while time.monotonic() < end:
        if found := condition():
            return found
        time.sleep(0.5)
    raise AssertionError(f"waited {limit} s for {what}")


class RvizShowsRobot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen, cls.display = start_screen()

    @classmethod
    def tearDownClass(cls):
        cls.screen.terminate()
        cls.screen.wait()

    def setUp(self):
        self.rviz = None

    def tearDown(self):
        if SAVE:
            cv2.imwrite(f"{SAVE}/{self._testMethodName}.png", self.picture()[..., ::-1])
        if self.rviz is not None:
            self.rviz.terminate()
            self.rviz.wait()

    def show(self, package, name):
        """rviz with a shipped configuration, as the launch files start it."""
        file = f"{rospkg.RosPack().get_path(package)}/rviz/{name}.rviz"
        environment = dict(os.environ, DISPLAY=self.display, LIBGL_ALWAYS_SOFTWARE="1",
                           QT_X11_NO_MITSHM="1")
        self.rviz = subprocess.Popen(
            ["rosrun", "rviz", "rviz", "-d", file, "__name:=rviz"], env=environment,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def picture(self):
        """The screen, (height, width, 3) RGB."""
        grab = ["ffmpeg", "-loglevel", "error", "-f", "x11grab", "-video_size",
                f"{WIDTH}x{HEIGHT}", "-i", self.display, "-frames:v", "1", "-f", "rawvideo",
                "-pix_fmt", "rgb24", "-"]
        raw = subprocess.run(grab, check=True, capture_output=True, timeout=LIMIT).stdout
        return np.frombuffer(raw, np.uint8).reshape(HEIGHT, WIDTH, 3)

    def wait_for_subscriptions(self, *topics):
        wait_until(lambda: set(topics) <= subscriptions("/rviz"),
                   f"rviz to subscribe to {topics}; it has {subscriptions('/rviz')}")

    def test_gazebo_model(self):
        self.show("turtlebot3_gazebo", "turtlebot3_gazebo_model")
        self.wait_for_subscriptions("/scan", "/camera/rgb/image_raw", "/tf", "/tf_static")
        wait_until(lambda: robot_pixels(self.picture()) > 1500, "the robot in the middle")
        wait_until(lambda: red_pixels(self.picture()) > 500, "the laser's red squares")
        wait_until(lambda: camera_pixels(self.picture()) > 5000, "the camera's picture")

    def test_everything(self):
        # conforms: contact_markers, contact_markers/TOPIC
        self.show("bullet_sim_ros", "everything")
        self.wait_for_subscriptions("/scan", "/camera/rgb/image_raw", "/odom", "/map",
                                    "/contact_markers", "/tf")
        wait_until(lambda: robot_pixels(self.picture()) > 1500, "the robot in the middle")
        wait_until(lambda: orange_pixels(self.picture()) > 100, "the arrow of the odometry")
        wait_until(lambda: red_pixels(self.picture()) > 500, "the laser's red squares")
        self.assertLess(bright_pixels(self.picture()), 20000)
        topics = publish_map(), publish_contact()
        wait_until(lambda: bright_pixels(self.picture()) > 50000, "the map's free cells")
        wait_until(lambda: magenta_pixels(self.picture()) > 50, "the contact's ball and arrow")
        for topic in topics:
            topic.unregister()

    def test_model_alone(self):
        self.show("turtlebot3_bringup", "model")
        self.wait_for_subscriptions("/tf", "/tf_static")
        wait_until(lambda: robot_pixels(self.picture()) > 10000, "the robot in the middle")


def view(picture):
    """The 3D view: right of the panels, below the tools."""
    return picture[70:810, 380:1180].astype(int)


def robot_pixels(picture):
    """How many are dark: the background and the grid are not, and the robot is."""
    middle = view(picture)[200:520, 200:600]
    return int((middle.max(axis=2) < 90).sum())


def red_pixels(picture):
    red, green, blue = np.moveaxis(view(picture), 2, 0)
    return int(((red > 200) & (green < 40) & (blue < 40)).sum())


def orange_pixels(picture):
    red, green, blue = np.moveaxis(view(picture), 2, 0)
    return int(((red > 120) & (green > 60) & (blue < 40) & (green < red)).sum())


def magenta_pixels(picture):
    red, green, blue = np.moveaxis(view(picture), 2, 0)
    return int(((red > 100) & (green < 60) & (blue > 100)).sum())


def bright_pixels(picture):
    return int((view(picture).min(axis=2) > 180).sum())


def publish_map():
    """6 x 6 m of free floor round the robot's start."""
    publisher = rospy.Publisher("/map", OccupancyGrid, queue_size=1, latch=True)
    grid = OccupancyGrid(data=[0] * 3600)
    grid.header.frame_id = "odom"
    grid.info.resolution, grid.info.width, grid.info.height = 0.1, 60, 60
    grid.info.origin.position.x, grid.info.origin.position.y = -5.0, -3.5
    grid.info.origin.orientation.w = 1.0
    publisher.publish(grid)
    return publisher


def publish_contact():
    """A touch beside the robot, again and again, on the topic that contact_markers listens to."""
    publisher = rospy.Publisher("/touch", ContactsState, queue_size=1)
    touch = ContactState(contact_positions=[Vector3(-2.0, -1.2, 0.2)],
                         contact_normals=[Vector3(0, 0, 1)],
                         wrenches=[Wrench(force=Vector3(0, 0, 20))])
    message = ContactsState(states=[touch])
    message.header.frame_id = "odom"
    rospy.Timer(rospy.Duration(0.1), lambda _: publisher.publish(message))
    return publisher


def camera_pixels(picture):
    """How many of the picture's panel are as grey as the ground; without a picture none is."""
    panel = picture[90:250, 10:330].astype(int)
    return int(((panel.min(axis=2) > 130) & (panel.max(axis=2) < 200)).sum())


if __name__ == "__main__":
    rospy.init_node("rviz_shows_robot")
    rostest.rosrun("turtlebot3_gazebo", "rviz_pictures", RvizShowsRobot, sys.argv)
