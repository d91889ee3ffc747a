#!/usr/bin/env python3
"""The window under Xvfb: a real X server with key repetition, keys pressed by XTEST."""

import os
import signal
import socket
import subprocess
import sys
import time
import tkinter
import unittest

import rospy
import rostest
from fake_controllers import LIMIT, FakeControllers, wait_until
from keyboard import NODE, Sent, end_node, start_node

STANDING = (0.0, 0.0)


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


class KeyboardWindow(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen, os.environ["DISPLAY"] = start_screen()
        cls.sent, cls.car = Sent(), FakeControllers()
        wait_until(lambda: cls.car.subscribers[0].get_num_connections(), "motor_control")

    @classmethod
    def tearDownClass(cls):
        cls.screen.terminate()
        cls.screen.wait()

    def setUp(self):
        self.node = start_node(stderr=subprocess.PIPE, text=True)
        self.window = wait_until(lambda: xdotool("search", "--name", "^key_control$"), "a window")
        connected = self.sent.subscriber.get_num_connections
        wait_until(connected, "the node's publisher")
        xdotool("windowfocus", "--sync", self.window)
        self.sent.forget()

    def tearDown(self):
        xdotool("keyup", "w", "keyup", "a", "keyup", "s", "keyup", "d")
        end_node(self.node)
        self.node.stderr.close()
        connected = self.sent.subscriber.get_num_connections
        wait_until(lambda: not connected(), "the end of the node's publisher")

    def hold(self, *keys):
        for key in keys:
            xdotool("keydown", key)

    def assert_ends_standing(self):
        self.assertEqual(self.node.wait(LIMIT), 0)
        self.sent.wait_for(STANDING)
        self.assertEqual(self.node.stderr.read(), "")

    def test_a_held_key_drives_and_its_release_stops(self):
        self.hold("w")
        self.sent.wait_for_number(25)  # 2.5 s: the screen repeats the key after 0.66 s
        self.assertEqual(set(self.sent.commands), {(2.0, 0.0)})
        self.car.wait_for_speed(2.0, "the wheels rolling")
        xdotool("keyup", "w")
        self.sent.wait_for(STANDING)
        wait_until(self.car.stand, "the wheels standing")
        self.sent.wait_for_silence()  # so that another node may drive

    def test_keys_together_and_opposite_ones(self):
        self.hold("w", "a")
        self.sent.wait_for((2.0, 0.34))
        self.hold("s")
        self.sent.wait_for((0.0, 0.34))
        xdotool("keyup", "w", "keyup", "a")
        self.sent.wait_for((-2.0, 0.0))
        self.hold("d")
        self.sent.wait_for((-2.0, -0.34))

    def test_capitals_and_arrows_are_the_same_keys(self):
        self.hold("shift", "w")
        self.sent.wait_for((2.0, 0.0))
        xdotool("keyup", "w", "keyup", "shift")
        self.sent.wait_for(STANDING)
        self.hold("Left")
        self.sent.wait_for((0.0, 0.34))
        xdotool("keyup", "Left")

    def test_a_window_that_loses_the_keyboard_stops_the_car(self):
        self.hold("w")
        self.sent.wait_for((2.0, 0.0))
        other = tkinter.Tk()
        other.focus_force()
        other.update()
        self.sent.wait_for(STANDING)
        self.sent.wait_for_silence()
        other.destroy()

    def test_q_ends_it(self):
        self.hold("w")
        self.sent.wait_for((2.0, 0.0))
        xdotool("key", "q")
        self.assert_ends_standing()

    def test_a_closed_window_ends_it(self):
        self.hold("w")
        self.sent.wait_for((2.0, 0.0))
        xdotool("windowclose", self.window)
        self.assert_ends_standing()

    def test_ctrl_c_and_rosnode_kill_end_it(self):
        self.hold("w")
        self.sent.wait_for((2.0, 0.0))
        os.killpg(self.node.pid, signal.SIGINT)
        self.assert_ends_standing()
        self.tearDown()
        self.setUp()
        subprocess.run(["rosnode", "kill", "/key_control"], stdout=subprocess.DEVNULL)
        self.assertEqual(self.node.wait(LIMIT), 0)

    def test_the_car_stops_when_it_is_killed(self):
        self.hold("w")
        self.car.wait_for_speed(2.0, "driving")
        os.killpg(self.node.pid, signal.SIGKILL)
        wait_until(self.car.stand, "standing")


class KeyboardAlone(unittest.TestCase):
    """What happens where something is missing."""

    def test_without_a_screen_one_line_says_what_to_type(self):
        for display in (None, ":7654"):
            environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
            if display:
                environment["DISPLAY"] = display
            done = subprocess.run(NODE, env=environment, capture_output=True, text=True,
                                  timeout=LIMIT, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn("no screen to open a window on", done.stderr)
            for way in ("rosrun car_control keyboard_control.py --terminal", "make drive",
                        "tab Drive: roslaunch sim_viewer viewer.launch control:=true"):
                self.assertIn(way, done.stderr)

    def test_it_ends_when_the_master_does(self):
        with socket.create_server(("localhost", 0)) as free:
            port = free.getsockname()[1]
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)],
                                  stdout=subprocess.DEVNULL)
        screen, display = start_screen()
        uri = f"http://localhost:{port}"
        node = start_node(stderr=subprocess.PIPE, text=True,
                          env=os.environ | {"ROS_MASTER_URI": uri, "DISPLAY": display})
        try:
            window = ["xdotool", "search", "--name", "^key_control$"]
            environment = os.environ | {"DISPLAY": display}
            wait_until(lambda: subprocess.run(window, env=environment, capture_output=True).stdout,
                       "a window")
            time.sleep(1.0)  # the window is up, the node is looking at its master
            master.kill()
            self.assertEqual(node.wait(LIMIT), 1)
            self.assertIn(f"the ROS master at {uri}/ has ended", node.stderr.read())
        finally:
            end_node(node)
            node.stderr.close()
            for process in (master, screen):
                process.kill()
                process.wait()


class Suite(unittest.TestSuite):
    """Both classes, for rostest takes one name."""

    def __init__(self):
        load = unittest.defaultTestLoader.loadTestsFromTestCase
        super().__init__([load(KeyboardWindow), load(KeyboardAlone)])


if __name__ == "__main__":
    rospy.init_node("keyboard_window_test")
    rostest.rosrun("car_control", "keyboard_window", "keyboard_window.Suite", sys.argv)
