#!/usr/bin/env python3
"""A person at a screen, who types COMMAND.

The screen is Xvfb's; its name is the parameter /acceptance_display.
"""

import os
import signal
import subprocess

import rospy

COMMAND = ("roslaunch", "racecar_description", "car_control.launch", "ackermann:=true",
           "command_timeout:=true")


def start_screen():
    """Xvfb on a free display; returns it and the display's name."""
    reader, writer = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "800x600x24", "-nolisten", "tcp"],
        pass_fds=[writer], stderr=subprocess.DEVNULL, start_new_session=True)
    os.close(writer)
    with os.fdopen(reader) as answer:
        return screen, f":{answer.readline().strip()}"


def main():
    screen, display = start_screen()
    typed = subprocess.Popen(COMMAND, env=os.environ | {"DISPLAY": display},
                             start_new_session=True)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: typed.send_signal(signal.SIGINT))
    rospy.set_param("/acceptance_display", display)
    typed.wait()
    screen.terminate()
    screen.wait()


if __name__ == "__main__":
    main()
