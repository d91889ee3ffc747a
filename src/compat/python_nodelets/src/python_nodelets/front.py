"""Debian's `nodelet`, but what is a Python node here is started as one, in the same name.

A node in place of a nodelet has the same parameters, topics and remappings: those of the process
that would have loaded it. Only what nodelets of one manager save, copying messages, is not saved.
"""

import os
import sys
from collections.abc import Sequence
from pathlib import Path

import rospkg
from roslib.packages import find_node

DEBIANS = "/usr/lib/nodelet/nodelet"

# Packages of nodelets that Debian has, and what to install for them.
INSTALLABLE = {"depth_image_proc": "libdepth-image-proc-dev", "image_proc": "libimage-proc-dev",
               "image_rotate": "libimage-rotate-dev",
               "image_publisher": "libimage-publisher-dev",
               "stereo_image_proc": "libstereo-image-proc-dev"}

# Type of a nodelet -> package and executable that do its work.
NODES = {
    "depthimage_to_laserscan/DepthImageToLaserScanNodelet":
        ("depthimage_to_laserscan", "depthimage_to_laserscan"),
    "pointcloud_to_laserscan/pointcloud_to_laserscan_nodelet":
        ("pointcloud_to_laserscan", "pointcloud_to_laserscan_node"),
    "pointcloud_to_laserscan/laserscan_to_pointcloud_nodelet":
        ("pointcloud_to_laserscan", "laserscan_to_pointcloud_node"),
    "yocs_cmd_vel_mux/CmdVelMuxNodelet": ("yocs_cmd_vel_mux", "cmd_vel_mux"),
    "cmd_vel_mux/CmdVelMuxNodelet": ("yocs_cmd_vel_mux", "cmd_vel_mux"),
    "robot_localization/EkfNodelet": ("robot_localization", "ekf_localization_node"),
    "robot_localization/UkfNodelet": ("robot_localization", "ukf_localization_node"),
}


def node_instead(words: Sequence[str]) -> list[str] | None:
    """The command line that does what `nodelet WORDS` would, or None where that is Debian's."""
    if len(words) < 2 or words[0] not in ("load", "standalone") or words[1] not in NODES:
        return None
    package, executable = NODES[words[1]]
    if has_nodelets(words[1].split("/")[0]):
        return None  # a package of the learner's own that has the real one
    found = find_node(package, executable)
    return [found[0], *(word for word in words[2:] if ":=" in word)] if found else None


def has_nodelets(package: str) -> bool:
    """Whether a package of that name, Debian's or the learner's, exports nodelets."""
    if (Path("/usr/share") / package / "nodelet_plugins.xml").exists():
        return True
    try:
        folder = rospkg.RosPack().get_path(package)
        return "<nodelet" in (Path(folder) / "package.xml").read_text(encoding="utf-8")
    except (rospkg.ResourceNotFound, OSError):
        return False


def missing(words: Sequence[str]) -> str:
    """What to type if the nodelet is one that Debian has and is not installed; else empty."""
    if len(words) < 2 or words[0] not in ("load", "standalone"):
        return ""
    package = words[1].split("/")[0]
    if package not in INSTALLABLE or has_nodelets(package):
        return ""
    return f"{words[1]} is not installed. Type: sudo apt-get install {INSTALLABLE[package]}"


def main() -> None:
    """Become the node, or Debian's nodelet."""
    words = sys.argv[1:]
    if line := missing(words):
        sys.exit(f"nodelet: {line}")
    command = node_instead(words) or [DEBIANS, *words]
    os.execv(command[0], command)
