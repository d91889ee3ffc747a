"""What every node here does alike: read its settings, and leave the car standing when it ends."""

from __future__ import annotations

import os
import signal
import sys
import threading
from pathlib import Path

import rospkg
import rospy
from rospy.client import load_command_line_node_params

from car_control.settings import Settings, SettingsError, load_settings

PATIENCE = 3.0  # s, wall, for the last message and for the master's answer that all is closed


def start_node(name: str, anonymous: bool = False) -> None:
    """init_node without its signal handlers; parameters such as `_kp:=2.5` are for this run only.

    rospy would write them to the parameter server, where the next run would find them:
    `read_settings` takes them from the command line itself. Ctrl-C while rospy waits for a master,
    about which it has said one line, ends the program.
    """
    names = [word for word in sys.argv if not load_command_line_node_params([word])]
    try:
        rospy.init_node(name, argv=names, anonymous=anonymous, disable_signals=True)
    except KeyboardInterrupt:
        sys.exit(128 + signal.SIGINT)


def read_settings(kind: type[Settings], file_name: str, section: str | None = None) -> Settings:
    """Settings from config/FILE_NAME of this package, or from the file in the parameter ~config.

    The node's other parameters override single keys; those on the command line win. Ends the
    program with one line if they do not fit.
    """
    given = rospy.get_param("~", {}) | load_command_line_node_params(sys.argv)
    folder = Path(rospkg.RosPack().get_path("car_control"), "config")
    try:
        return load_settings(kind, given.pop("config", folder / file_name), section, given)
    except SettingsError as error:
        rospy.logfatal("%s", error)
        sys.exit(1)


class Ending:
    """Ctrl-C, a closed terminal, `rosnode kill`: in each case there is time for a last message.

    Make this right after `start_node`. A signal only sets
    `asked`; the main thread sees it, sends what is to be sent, and calls `done`. rospy waits for
    a master that is gone or hangs for ever, in that thread: then the program just ends.
    """

    def __init__(self) -> None:
        self.asked = threading.Event()
        self._done = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self._ask)
        rospy.on_shutdown(self._shut_down)

    def _ask(self, number: int, _frame: object) -> None:
        self.asked.set()
        last = threading.Timer(PATIENCE, os._exit, (128 + number,))
        last.daemon = True
        last.start()

    def done(self) -> None:
        """The last message is out: ROS may close the connections."""
        self._done.set()
        rospy.signal_shutdown("ended")

    def _shut_down(self) -> None:
        """Runs on ROS's thread when the master asks; the connections live until it returns."""
        self.asked.set()
        self._done.wait(2.0)  # s
