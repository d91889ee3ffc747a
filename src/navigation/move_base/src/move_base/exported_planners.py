"""Planners in Python that other packages export: found as pluginlib finds C++ ones, and adapted.

package.xml:  <export><nav_core plugin="${prefix}/planner_plugin.xml"/></export>
that file:    <library path="src">
                <class name="my_package/MyPlanner" type="my_package.my_module.MyPlanner"
                       base_class_type="nav_core::BaseGlobalPlanner"/>
              </library>
`path`, relative to the package, is searched for the module, besides PYTHONPATH.
"""

from __future__ import annotations

import importlib
import sys
import traceback
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import rospkg
import rospy
from geometry_msgs.msg import Twist

from costmap_2d import CostmapROS
from move_base.global_planners import GLOBAL_PLANNERS, GlobalPlanner
from move_base.local_planners import LOCAL_PLANNERS, LocalPlanner, Situation
from move_base.plugin import chosen
from nav_algorithms.costmap.costs import Costmap
from nav_algorithms.local_planning.velocities import Command
from nav_nodes.messages import pose_of, stamped_pose
from nav_nodes.parameters import Parameter, ParameterError

GLOBAL, LOCAL = "nav_core::BaseGlobalPlanner", "nav_core::BaseLocalPlanner"
NEEDED = {GLOBAL: ("initialize", "make_plan"),
          LOCAL: ("initialize", "set_plan", "compute_velocity_commands", "is_goal_reached")}
ODOMETRY = Parameter("odom_topic", "str", "odom", meaning="odometry with the robot's velocity")


@dataclass(frozen=True)
class Exported:
    """One class of an XML file: `type` is module.Class, `folder` is searched for the module."""

    name: str
    type: str
    base: str
    folder: Path
    file: Path


def exported(base: str) -> dict[str, Exported]:
    """The Python classes with this base in all packages, by name. C++ classes are left out.

    Raises ParameterError, which names the file, if one cannot be read.
    """
    packages = rospkg.RosPack()
    found = {}
    for package in packages.list():
        for attribute in _exports(packages, package):
            for each in _classes(packages.get_path(package), attribute):
                if each.base == base and "::" not in each.type:
                    found[each.name] = each
    return found


def _exports(packages: rospkg.RosPack, package: str) -> list[str]:
    """Files exported by its package.xml; a broken one is left for catkin to report."""
    try:
        return packages.get_manifest(package).get_export("nav_core", "plugin")
    except Exception:  # rospkg raises anything, UnboundLocalError among it
        return []


def _classes(package: str, attribute: str) -> list[Exported]:
    file = Path(attribute.replace("${prefix}", package))
    try:
        libraries = list(ET.parse(file).getroot().iter("library"))
        return [Exported(entry.get("name", entry.attrib["type"]), entry.attrib["type"],
                         entry.attrib["base_class_type"],
                         Path(package) / library.get("path", "."), file)
                for library in libraries for entry in library.iter("class")]
    except (OSError, ET.ParseError, KeyError) as error:
        raise ParameterError(f"{file}, named in {package}/package.xml: {error!r}; it must hold "
                             "<library path=\"src\"><class name= type= base_class_type=/>"
                             "</library>") from None


def load(entry: Exported) -> type:
    """The class. Raises ParameterError that says what is wrong, and where."""
    module, _, name = entry.type.rpartition(".")
    if str(entry.folder) not in sys.path:
        sys.path.append(str(entry.folder))
    try:
        found = getattr(importlib.import_module(module), name)
    except Exception as error:  # importing a learner's module may raise anything
        raise ParameterError(f"{entry.file}: {entry.name} is {entry.type}, but "
                             f"{type(error).__name__}: {error}") from error
    missing = [method for method in NEEDED[entry.base] if not hasattr(found, method)]
    if missing:
        raise ParameterError(f"{entry.file}: {entry.type} has no {' and no '.join(missing)}, but "
                             f"{entry.base} needs {', '.join(NEEDED[entry.base])}")
    return found


class ExportedGlobalPlanner(GlobalPlanner):
    """Wraps class WRAPPED: initialize(name, costmap), make_plan(start, goal) -> [PoseStamped]."""

    WRAPPED: type

    def __init__(self, costmap: CostmapROS) -> None:
        self._costmap, self._wrapped = costmap, self.WRAPPED()
        self._wrapped.initialize(self.NAME, costmap)
        super().__init__(costmap)

    @property
    def entries(self) -> list[Parameter]:
        return []

    def change(self, values: dict) -> None:
        self.values = values

    def _plan(self, costmap: Costmap, footprint: np.ndarray, start: np.ndarray,
              goal: np.ndarray) -> np.ndarray | None:
        frame, now = self._costmap.global_frame, rospy.Time.now()
        plan = self._wrapped.make_plan(*(stamped_pose(each, frame, now) for each in (start, goal)))
        return np.array([pose_of(each.pose) for each in plan]) if plan else None


class ExportedLocalPlanner(LocalPlanner):
    """Wraps class WRAPPED: initialize(name, tf, costmap), set_plan([PoseStamped]) -> bool,
    compute_velocity_commands() -> Twist or None, is_goal_reached() -> bool.
    """

    WRAPPED: type

    def __init__(self, controller_frequency: float, costmaps: tuple[CostmapROS, CostmapROS]
                 ) -> None:
        self._fixed, local = costmaps
        self._wrapped = self.WRAPPED()
        self._wrapped.initialize(self.NAME, local.transforms.buffer, local)
        super().__init__(controller_frequency, costmaps)

    @property
    def entries(self) -> list[Parameter]:
        return [ODOMETRY]

    def change(self, values: dict) -> None:
        self.values = values

    def set_path(self, path: np.ndarray, again: bool) -> None:
        frame, now = self._fixed.global_frame, rospy.Time.now()
        with self._lock:
            if not self._wrapped.set_plan([stamped_pose(pose, frame, now) for pose in path]):
                raise ValueError(f"{self.NAME} does not take it")
            self._path = path

    def fastest(self) -> tuple[float, float]:
        """Unknown, so infinite."""
        return np.inf, np.inf

    def reached(self, situation: Situation) -> bool:
        return bool(self._wrapped.is_goal_reached())

    def command(self, situation: Situation) -> Command | None:
        try:
            twist: Twist | None = self._wrapped.compute_velocity_commands()
        except Exception:  # a learner's fault must not leave the robot with its last velocity
            rospy.logerr_throttle(5.0, f"{self.NAME} failed: {traceback.format_exc()}")
            return None
        if twist is None:
            return None
        command = Command(twist.linear.x, twist.linear.y, twist.angular.z, situation.pose[None])
        with self._lock:
            if not self._closed:
                self._publish(situation, command)
        return command


def global_planner(name: str, where: str) -> type[GlobalPlanner]:
    """A planner of ours or of any package. Raises ParameterError that lists the known ones."""
    return _kind(name, where, GLOBAL_PLANNERS, GLOBAL)


def local_planner(name: str, where: str) -> type[LocalPlanner]:
    """As global_planner."""
    return _kind(name, where, LOCAL_PLANNERS, LOCAL)


def _kind(name: str, where: str, ours: Mapping[str, type], base: str) -> type:
    if name in ours or name in {full.rpartition("/")[2] for full in ours}:
        return chosen(name, ours, where)
    found = exported(base)
    return _placed(chosen(name, {**found, **ours}, where))


@cache
def _placed(entry: Exported) -> type:
    """The adapter class, made once per entry, so that the same name gives the same class."""
    kind = ExportedGlobalPlanner if entry.base == GLOBAL else ExportedLocalPlanner
    return type(entry.type.rpartition(".")[2], (kind,), {
        "NAME": entry.name.rpartition("/")[2], "WRAPPED": load(entry)})
