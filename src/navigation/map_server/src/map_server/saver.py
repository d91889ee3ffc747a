"""The node map_saver: saves one published map as two files."""

from __future__ import annotations

import argparse
import sys
import threading
from pathlib import Path

import rospy
from nav_msgs.msg import OccupancyGrid

from map_server.map_files import check_target, write_map
from nav_nodes.messages import grid_of, yaw_of
from nav_nodes.missing_data import MissingData, is_published, why_silent
from nav_nodes.program import init_node

POLL = 0.5  # s of wall time


class MapSaver:
    """Waits for one map, and logs what it waits for."""

    def __init__(self) -> None:
        """rospy is initialised."""
        self._came = threading.Event()
        self._message: OccupancyGrid | None = None
        self._maps = rospy.Subscriber("map", OccupancyGrid, self._take, queue_size=1)
        rospy.loginfo("Waiting for the map")

    def wait(self) -> OccupancyGrid | None:
        """The first map received; None if the node is shut down before."""
        missing_data = MissingData()
        while not self._came.wait(POLL) and not rospy.is_shutdown():
            missing_data.missing(f"map on {self._maps.resolved_name}", self._why())
        return self._message

    def _take(self, message: OccupancyGrid) -> None:
        if self._message is None:
            self._message = message
            self._came.set()

    def _why(self) -> str:
        if is_published(self._maps):
            return "its publisher has not sent one yet"
        return why_silent(self._maps, "map")


def main() -> int:
    """The exit status: 0 when the map is written, 1 with one line that says what is wrong."""
    options = _options(rospy.myargv()[1:])
    try:
        check_target(options.f)
        init_node("map_saver")
        message = MapSaver().wait()
        if message is None:
            return 1
        grid = grid_of(message)
        rospy.loginfo("Received a %d X %d map @ %.3f m/pix", *grid.cells.shape[::-1],
                      grid.resolution)
        paths = write_map(options.f, grid, yaw_of(message.info.origin.orientation), options.occ,
                          options.free)
    except ValueError as error:  # MapFileError, or an invalid map in grid_of or OccupancyGrid
        print(f"map_saver: {error}", file=sys.stderr)
        return 1
    rospy.loginfo("Wrote %s and %s", *paths)
    return 0


def _options(arguments: list[str]) -> argparse.Namespace:
    """The command line; an error in it ends the program with status 1, as upstream's."""
    parser = _Parser(prog="map_saver", description=__doc__, epilog="map:=TOPIC: another topic")
    parser.add_argument("--occ", type=_percent, default=65, metavar="PERCENT",
                        help="cells from here on are occupied; default: 65")
    parser.add_argument("--free", type=_percent, default=25, metavar="PERCENT",
                        help="cells up to here are free; default: 25")
    parser.add_argument("-f", type=Path, default=Path("map"), metavar="NAME",
                        help="writes NAME.pgm and NAME.yaml; default: map")
    options = parser.parse_args(arguments)
    if options.free >= options.occ:
        parser.error(f"--free {options.free} must be below --occ {options.occ}")
    return options


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> None:
        self.exit(1, f"map_saver: {message}; usage: map_saver [--occ 65] [--free 25] [-f NAME] "
                     f"[map:=TOPIC]\n")


def _percent(text: str) -> int:
    if not text.isdigit() or int(text) > 100:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 to 100")
    return int(text)
