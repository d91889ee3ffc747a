"""A node's own parameters: from a launch file or `_key:=value`, and changed while it runs.

`rosrun dynamic_reconfigure dynparam set NODE KEY VALUE` changes one; the settings' dataclass
replaces a .cfg file.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import rospkg
import rospy
from dynamic_reconfigure.server import Server
from node_basics.reconfigure import serve_settings
from node_basics.settings import Settings, SettingsError, checked, load_settings
from rospy.client import load_command_line_node_params


def own_parameters() -> dict[str, object]:
    """By name, without `~`; those from the command line are deleted from the parameter server.

    SettingsError if a single value is in place of all of them.
    """
    given = rospy.get_param("~", {})
    if not isinstance(given, dict):
        raise SettingsError(f"the parameter {rospy.get_name()} is {given!r}: there should be "
                            f"parameters below it; type: rosparam delete {rospy.get_name()}")
    for key in load_command_line_node_params(sys.argv):
        rospy.delete_param(f"~{key}")  # _key:=value must not affect the next run
    return dict(given)


def read_settings(kind: type[Settings], section: str) -> Settings:
    """Settings from a section of config/tracking_params.yaml, or of the file in ~config.

    The node's other parameters override the file. If a value is invalid, exits with one line.
    """
    folder = Path(rospkg.RosPack().get_path("ai_robot_tracking"), "config")
    try:
        given = own_parameters()
        path = Path(str(given.pop("config", folder / "tracking_params.yaml")))
        return load_settings(kind, path, section, given)
    except SettingsError as error:
        rospy.logfatal("%s", error)
        sys.exit(1)


def offer_settings(settings: Settings, apply: Callable[[Settings], None]) -> Server:
    """Offer all numbers; `apply` gets them now and after each change, in ROS's threads."""
    return serve_settings(settings, checked, apply)
