"""Shared by all nodes: reading settings, and stopping the car when the node ends."""

from __future__ import annotations

import os
import signal
import sys
import threading
from pathlib import Path

import rospkg
import rospy
from node_basics.ending import at_signals
from node_basics.settings import Settings, SettingsError, load_settings
from rospy.client import load_command_line_node_params
from std_msgs.msg import Bool

PATIENCE = 3.0  # s, wall, for the last message and for unregistering from the master


def start_node(name: str, anonymous: bool = False) -> None:
    """init_node without its signal handlers; parameters such as `_kp:=2.5` only hold for this run.

    rospy would write them to the parameter server, where the next run would find them;
    `read_settings` reads them from the command line instead. Ctrl-C while rospy waits for a master
    (it has logged a line about that) ends the program.
    """
    names = [word for word in sys.argv if not load_command_line_node_params([word])]
    try:
        rospy.init_node(name, argv=names, anonymous=anonymous, disable_signals=True)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


def read_settings(kind: type[Settings], file_name: str, section: str | None = None) -> Settings:
    """Settings from config/FILE_NAME of this package, or from the file in the parameter ~config.

    The node's other parameters override single keys; those on the command line take precedence.
    If a value is invalid, exits with one line.
    """
    given = rospy.get_param("~", {}) | load_command_line_node_params(sys.argv)
    folder = Path(rospkg.RosPack().get_path("car_control"), "config")
    try:
        return load_settings(kind, given.pop("config", folder / file_name), section, given)
    except SettingsError as error:
        rospy.logfatal("%s", error)
        sys.exit(1)


class StopNotice:
    """Says in a node that drives when motor_control's emergency stop is on, and how to release it.

    motor_control keeps the last state on `estop_state`, for nodes that start later.
    """

    def __init__(self) -> None:
        self.is_on = False
        rospy.Subscriber("estop_state", Bool, self._take, queue_size=1)

    def _take(self, state: Bool) -> None:
        if state.data and not self.is_on:
            rospy.logwarn("the emergency stop is on, and the car stands. To release it, type: %s",
                          release())
        elif self.is_on and not state.data:
            rospy.loginfo("the emergency stop is over")
        self.is_on = state.data


def release() -> str:
    """The command that releases the emergency stop."""
    return f"rostopic pub -1 {rospy.resolve_name('estop')} std_msgs/Bool false"


class Ending:
    """Leaves time for a last message at Ctrl-C, a closed terminal, or `rosnode kill`.

    Create it right after `start_node`. A signal only sets `asked`; the main thread sees it, sends
    its last messages, and calls `done`. If the master is gone or hangs, rospy would wait for it
    forever; then the program just ends.
    """

    def __init__(self) -> None:
        self.asked = threading.Event()
        self._done = threading.Event()
        at_signals(self.asked.set, PATIENCE, os._exit)
        rospy.on_shutdown(self._shut_down)

    def done(self) -> None:
        """The last message was sent: ROS may close the connections."""
        self._done.set()
        rospy.signal_shutdown("ended")

    def _shut_down(self) -> None:
        """Runs in ROS's thread when the master asks; connections stay open until it returns."""
        self.asked.set()
        self._done.wait(2.0)  # s
