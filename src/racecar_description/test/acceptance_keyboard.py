"""The keyboard window of car_control.launch on acceptance_user's screen, with real key events."""

import os

import rospy
from acceptance_car import wait_until, xdotool

FULL_SPEED = 2.0  # m/s, of the page's W


class Keyboard:
    """Has the window in focus; `hold` and `release` are for W."""

    def __init__(self):
        wait_until(lambda: rospy.has_param("/acceptance_display"), "a screen")
        os.environ["DISPLAY"] = rospy.get_param("/acceptance_display")
        window = wait_until(lambda: xdotool("search", "--name", "^key_control$"), "a window")
        wait_until(lambda: "/key_control" in publishers_of("/motor_output"), "the window's topic")
        xdotool("windowfocus", "--sync", window)

    def hold(self):
        xdotool("keydown", "w")

    def release(self):
        xdotool("keyup", "w")


def publishers_of(topic):
    """Names of the nodes that publish it."""
    publishers = rospy.get_master().getSystemState()[2][0]
    return dict(publishers).get(topic, [])
