"""The window under Xvfb: its title, size and pixels, and what ends it."""

import os
import signal
import subprocess
import unittest

import numpy as np
import rosgraph
import rospy
from pond_watch import LIMIT, service_names, start_node, wait_until
from std_srvs.srv import Empty
from turtlesim.srv import SetPen, TeleportAbsolute

BACKGROUND = (69, 86, 255)


def start_screen():
    """Xvfb on a free display; returns it and the display's name."""
    reader, writer = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
        pass_fds=[writer], stderr=subprocess.DEVNULL,
    )
    os.close(writer)
    with os.fdopen(reader) as answer:
        return screen, f":{answer.readline().strip()}"


def xdotool(*arguments):
    done = subprocess.run(["xdotool", *arguments], capture_output=True, text=True, timeout=LIMIT)
    return done.stdout.strip()


def seen():
    """(500, 500, 3) RGB: the screen's upper left corner, where the window is without a manager."""
    grab = ["ffmpeg", "-loglevel", "error", "-f", "x11grab", "-draw_mouse", "0", "-video_size",
            "500x500", "-i", os.environ["DISPLAY"], "-frames:v", "1", "-f", "rawvideo",
            "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(grab, capture_output=True, timeout=LIMIT, check=True)
    return np.frombuffer(done.stdout, np.uint8).reshape(500, 500, 3)


class WindowStory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen, os.environ["DISPLAY"] = start_screen()

    @classmethod
    def tearDownClass(cls):
        cls.screen.terminate()
        cls.screen.wait()

    def setUp(self):
        self.node = start_node("turtlesim_node", stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.end)
        self.window = wait_until(lambda: xdotool("search", "--name", "^TurtleSim$"), "a window")
        wait_until(lambda: "/kill" in service_names(), "the node's services")

    def end(self):
        if self.node.poll() is None:
            os.killpg(self.node.pid, signal.SIGINT)
        self.node.wait(LIMIT)
        self.node.stderr.close()
        wait_until(lambda: "/kill" not in service_names(), "the end of the node")

    def assert_seen(self, row, column, color):
        wait_until(lambda: tuple(seen()[row, column]) == color, f"{color} at {row}, {column}")

    def test_size_picture_and_changes(self):
        self.assertIn("Geometry: 500x500", xdotool("getwindowgeometry", self.window))
        self.assert_seen(2, 2, BACKGROUND)
        self.assertGreater(np.ptp(seen()[225:275, 225:275], axis=(0, 1)).max(), 30)
        rospy.ServiceProxy("/turtle1/set_pen", SetPen)(255, 0, 0, 9, 0)
        jump = rospy.ServiceProxy("/turtle1/teleport_absolute", TeleportAbsolute)
        jump(1, 1, 0)
        jump(10, 10, 0)
        self.assert_seen(252, 247, (255, 0, 0))
        rospy.set_param("/turtlesim/background_r", 150)
        rospy.ServiceProxy("/clear", Empty)()
        self.assert_seen(252, 247, (150, 86, 255))

    def test_there_is_no_image_topic_beside_a_window(self):
        published = [name for name, _ in rosgraph.Master("/x").getSystemState()[0]]
        self.assertNotIn("/turtlesim/image", published)

    def test_closing_the_window_ends_the_node(self):
        xdotool("windowclose", self.window)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(self.node.stderr.read(), "")

    def test_ctrl_c_ends_the_node(self):
        os.killpg(self.node.pid, signal.SIGINT)
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.assertEqual(self.node.stderr.read(), "")
