"""slam_gmapping_replay: map and trajectory from a bag, as fast as possible. No master."""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from collections import deque
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import genmsg
import genpy
import numpy as np
import rosbag
import rospkg
import rospy
import tf2_py
import yaml
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from gmapping.mapper import TABLE, Mapper, ScanError
from map_server.errors import MapFileError
from map_server.map_files import write_map
from nav_nodes.ignored import ignored
from nav_nodes.laser_mount import Mount
from nav_nodes.messages import yaw_of
from nav_nodes.parameters import ParameterError, load_table

SCANS = ("sensor_msgs/LaserScan",)
TRANSFORMS = ("tf2_msgs/TFMessage", "tf/tfMessage")
BAG_ERRORS = (OSError, ValueError, rosbag.ROSBagException, genpy.MessageException,
              genmsg.MsgNotFound, genmsg.InvalidMsgSpec)
FAR, END = 2.0e9, 2**32 - 100  # s: stamps so far apart, or so late, make tf2 abort
WAITING = 5.0  # s; a scan that is older than the newest by this, without odometry, is skipped


class BagError(Exception):
    """A bag cannot be read, or no map can be made from it."""


class BagScans:
    """The scans of a bag with odometry and mount, in the bag's order."""

    def __init__(self, path: Path, topic: str, odom_frame: str, base_frame: str) -> None:
        """Raises BagError if there is no readable bag; iterating may raise it, too."""
        with _bag_errors():
            self._bag = rosbag.Bag(str(path))
        self._topics = [topic.lstrip("/"), "/" + topic.lstrip("/")]
        self._frames = odom_frame.lstrip("/"), base_frame.lstrip("/")
        self._transforms = tf2_py.BufferCore(rospy.Duration(30.0))
        self._first_stamp: float | None = None
        self.left_out = 0
        self._missing = ""

    def why_none(self) -> str:
        """Why no scan was usable, after all were read."""
        if self.left_out:
            return (f"none of the {self.left_out} scans on {self._topics[1]} can be placed"
                    + self._missing)
        with _bag_errors():
            topics = self._bag.get_type_and_topic_info().topics
        others = sorted(topic for topic, info in topics.items() if info.msg_type in SCANS)
        return (f"no scans on {self._topics[1]}; scans are on: "
                + (_short(", ".join(others)) or "no topic"))

    def __iter__(self) -> Iterator[tuple[LaserScan, np.ndarray, Mount]]:
        waiting: deque[LaserScan] = deque()
        for topic, message in self._messages():
            if topic in self._topics:
                if not self._is_usable(message.header):
                    self.left_out += 1
                    continue
                waiting.append(message)
                while abs((message.header.stamp - waiting[0].header.stamp).to_sec()) > WAITING:
                    waiting.popleft()
                    self.left_out += 1
            else:
                self._keep(message, topic.endswith("static"))
            yield from self._ready(waiting)
        self.left_out += len(waiting)

    def _messages(self) -> Iterator[tuple[str, Any]]:
        transforms = ("tf", "/tf", "tf_static", "/tf_static")
        kinds = dict.fromkeys(self._topics, SCANS) | dict.fromkeys(transforms, TRANSFORMS)
        with _bag_errors():
            for topic, (kind, data, *_), _ in self._bag.read_messages(topics=list(kinds), raw=True):
                if kind not in kinds[topic]:
                    raise BagError(f"{topic} is of {kind}, not {kinds[topic][0]}")
                made = LaserScan() if kind in SCANS else TFMessage()
                yield topic, made.deserialize(data)  # a bag contains its message definitions

    def _keep(self, message: Any, is_static: bool) -> None:
        keep = (self._transforms.set_transform_static if is_static
                else self._transforms.set_transform)
        for transform in message.transforms:
            transform.header.frame_id = transform.header.frame_id.lstrip("/")
            transform.child_frame_id = transform.child_frame_id.lstrip("/")
            if self._is_usable(transform.header):
                keep(transform, "bag")

    def _is_usable(self, header: Header) -> bool:
        """Whether tf2 can handle its stamp and frame; stamp 0: of a static transform."""
        stamp = header.stamp.to_sec()
        if stamp and self._first_stamp is None:
            self._first_stamp = stamp
        return "\0" not in header.frame_id and (
            not stamp or (stamp < END and abs(stamp - self._first_stamp) < FAR))

    def _ready(self, waiting: deque[LaserScan]) -> Iterator[tuple[LaserScan, np.ndarray, Mount]]:
        """Yields scans from the queue's head while their transforms are known."""
        odom, base = self._frames
        while waiting:
            scan = waiting[0]
            frame = scan.header.frame_id.lstrip("/")
            parent, child = odom, base
            try:
                pose = self._transforms.lookup_transform_core(parent, child, scan.header.stamp)
                parent, child = base, frame
                laser = self._transforms.lookup_transform_core(parent, child, scan.header.stamp)
            except tf2_py.TransformException:
                self._missing = (f": no transform from {_short(parent)} to {_short(child)} on /tf "
                                 "or /tf_static")
                return
            waiting.popleft()
            at = pose.transform
            yield (scan, np.array([at.translation.x, at.translation.y, yaw_of(at.rotation)]),
                   Mount.of(laser.transform))


def _short(names: str) -> str:
    """Text from a bag, as one short line."""
    return " ".join(names.split())[:200]


@contextlib.contextmanager
def _bag_errors() -> Iterator[None]:
    """Converts what rosbag raises while it reads to a BagError."""
    try:
        yield
    except BAG_ERRORS as error:
        raise BagError(getattr(error, "strerror", None) or error) from error
    except KeyError as error:
        raise BagError(f"it names a connection {error} that it does not have") from error


def values_from(settings: list[str], seed: int | None, params: Path | None) -> dict[str, Any]:
    """Every parameter of the table; `settings` are NAME:=VALUE. Raises ParameterError."""
    table = load_table(Path(rospkg.RosPack().get_path("gmapping")) / TABLE)
    given = _yaml(params.read_text(encoding="utf-8"), str(params)) if params else {}
    if not isinstance(given, dict):
        raise ParameterError(f"{params} must hold NAME: VALUE lines, such as particles: 30")
    for setting in settings:
        name, separator, value = setting.partition(":=")
        if not separator:
            raise ParameterError(f"{setting} is not NAME:=VALUE")
        given[name.lstrip("_~")] = _yaml(value, setting)
    if seed is not None:
        given["seed"] = seed
    strange = given.keys() - {entry.name for entry in table}
    if strange:
        names = ", ".join(sorted(map(str, strange)))
        raise ParameterError(f"slam_gmapping has no parameter {names}")
    for line in ignored(given, {"": table}):
        print(f"slam_gmapping_replay: a parameter without effect: {line}", file=sys.stderr)
    return {entry.name: entry.checked(given.get(entry.name, entry.default), entry.name)
            for entry in table}


def _yaml(text: str, where: str) -> Any:
    """The parsed value; raises ParameterError that names `where`."""
    try:
        return yaml.safe_load(text)
    except Exception as error:  # PyYAML also raises KeyError, IndexError and more
        raise ParameterError(f"{where:.500} is not valid YAML: "
                             f"{' '.join(str(error).split())[:200]}") from None


def write_trajectory(path: Path, stamps: np.ndarray, poses: np.ndarray) -> None:
    """Write one line per pose, "stamp x y z qx qy qz qw", the TUM trajectory format."""
    lines = [f"{stamp:.9f} {x:.6f} {y:.6f} 0 0 0 {np.sin(yaw / 2):.9f} {np.cos(yaw / 2):.9f}\n"
             for stamp, (x, y, yaw) in zip(stamps, poses, strict=True)]
    path.write_text("".join(lines), encoding="utf-8")


def main(arguments: list[str] | None = None) -> int:
    """The exit status: 0, or 1 with one line that says what is wrong."""
    options = _parser().parse_intermixed_args(arguments)
    try:
        values = values_from(options.settings, options.seed, options.params)
        scans = BagScans(options.bag, options.scan_topic, values["odom_frame"],
                         values["base_frame"])
        return _replay(scans, Mapper(values), options)
    except (OSError, BagError, MapFileError, ParameterError, UnicodeDecodeError) as error:
        print(f"slam_gmapping_replay: {options.bag}: {error}", file=sys.stderr)
        return 1


def _replay(scans: BagScans, mapper: Mapper, options: argparse.Namespace) -> int:
    start, stamps, refused = time.monotonic(), [], []
    for scan, odometry, mount in scans:
        if mapper.is_wanted():
            try:
                mapper.take(scan, odometry, mount)
            except ScanError as error:
                refused.append(error)
                continue
            stamps.append(scan.header.stamp.to_sec())
    of_no_use = f"{len(refused)} scans of no use, the first: {refused[0]}" if refused else ""
    if mapper.slam is None:
        raise BagError(of_no_use or scans.why_none())
    if refused:
        print(f"slam_gmapping_replay: {options.bag}: {of_no_use}", file=sys.stderr)
    write_map(options.map, mapper.slam.grid())
    write_trajectory(Path(f"{options.map}.tum"), *mapper.slam.trajectory())
    took, lasted = time.monotonic() - start, stamps[-1] - stamps[0]
    print(f"{len(stamps)} scans of {lasted:.0f} s in {took:.1f} s, {lasted / took:.1f} times real "
          f"time; {scans.left_out} without odometry; wrote {options.map}.yaml and .tum")
    return 0


class _OneLineParser(argparse.ArgumentParser):
    def error(self, message: str) -> None:
        usage = " ".join(self.format_usage().split())
        self.exit(1, f"{self.prog}: {message}; {usage}\n")


def _parser() -> argparse.ArgumentParser:
    parser = _OneLineParser(prog="slam_gmapping_replay", description=__doc__)
    parser.add_argument("bag", type=Path, help="the bag: scans, /tf and /tf_static")
    parser.add_argument("--scan_topic", default="scan", help="default: scan")
    parser.add_argument("--map", type=Path, default=Path("map"),
                        help="writes MAP.pgm, MAP.yaml and MAP.tum, the trajectory; default: map")
    parser.add_argument("--params", type=Path, help="a YAML file of slam_gmapping's parameters")
    parser.add_argument("--seed", type=int, help="of the random draws; default: the parameter's")
    parser.add_argument("settings", nargs="*", default=[], metavar="_NAME:=VALUE",
                        help="a parameter of slam_gmapping")
    return parser
