"""Recovery behaviours for when no plan or no velocity is found: upstream's, and one of ours.

Each runs in steps, one per period of the control loop, so that goals can be cancelled meanwhile.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
import rospy

from costmap_2d import CostmapROS
from move_base.base import Base
from move_base.plugin import chosen, settings_from, table
from nav_algorithms import recovery
from nav_algorithms.costmap import footprint as footprints
from nav_algorithms.poses import wrap_angle
from nav_nodes.parameters import Parameter, read_parameters

LIMITS = "TrajectoryPlannerROS"  # namespace in which upstream's rotate_recovery reads its speeds
TOO_LONG = 2.0  # multiple of a drive's expected time after which it is given up


@dataclass(frozen=True)
class RecoveryContext:
    """The parts that behaviours use. `frequency`: of their steps, Hz."""

    global_costmap: CostmapROS
    local_costmap: CostmapROS
    base: Base
    frequency: float


class Recovery(ABC):
    """One behaviour with its parameters from `~NAME/`."""

    TABLE = ""

    def __init__(self, name: str) -> None:
        """Raises ParameterError for an invalid value."""
        self.name = name
        self.values: dict[str, Any] = read_parameters(self.entries, f"~{name}/")

    @property
    def entries(self) -> list[Parameter]:
        """The parameters that it reads below its own name."""
        return table(self.TABLE)

    def start(self, context: RecoveryContext) -> None:
        """Begin; the robot stands."""
        self.context = context

    @abstractmethod
    def step(self) -> bool:
        """Do one step; returns whether it is done. Called only while sensor data is current."""


class ClearCostmap(Recovery):
    """clear_costmap_recovery/ClearCostmapRecovery: obstacles far from the robot are forgotten."""

    TABLE = "clear_costmap_recovery"

    def step(self) -> bool:
        values = self.values
        maps = {"local": [self.context.local_costmap], "global": [self.context.global_costmap]}.get(
            values["affected_maps"], [self.context.global_costmap, self.context.local_costmap])
        rospy.logwarn("Clearing %s costmap%s %sside a square (%.2fm) large centered on the robot.",
                      values["affected_maps"], "s" if len(maps) > 1 else "",
                      "in" if values["invert_area_to_clear"] else "out", values["reset_distance"])
        for costmap in maps:
            costmap.clear_area(values["reset_distance"], values["layer_names"],
                               values["invert_area_to_clear"])
            if values["force_updating"]:
                costmap.update()
        return True


class Rotate(Recovery):
    """rotate_recovery/RotateRecovery: one turn on the spot, to see all round."""

    TABLE = "rotate_recovery"

    def __init__(self, name: str) -> None:
        super().__init__(name)
        others = [entry for entry in table(self.TABLE) if entry not in self.entries]
        self.values.update(read_parameters(others, f"~{LIMITS}/"))
        self._settings = settings_from(recovery.RotateSettings, self.values)

    @property
    def entries(self) -> list[Parameter]:
        return [entry for entry in super().entries
                if entry.name in ("sim_granularity", "frequency")]

    def start(self, context: RecoveryContext) -> None:
        super().start(context)
        rospy.logwarn("Rotate recovery behavior started.")
        self._turned, self._yaw = 0.0, None
        slowest = max(self._settings.min_in_place_vel_theta, 0.05)
        self._steps_left = int(TOO_LONG * 2 * np.pi / slowest * context.frequency)

    def step(self) -> bool:
        pose = self.context.local_costmap.robot_pose()
        if pose is None:
            return False
        if self._yaw is not None:
            self._turned += wrap_angle(pose[2] - self._yaw)
        self._yaw = pose[2]
        command = recovery.rotation(self.context.local_costmap.snapshot(),
                                    self.context.local_costmap.footprint, pose, self._turned,
                                    self._settings)
        self._steps_left -= 1
        if command is None:
            rospy.logerr("Rotate recovery can't rotate in place because there is a potential "
                         "collision.")
        if command is None or not command.omega or not self._steps_left:
            self.context.base.stop()
            return True
        self.context.base.drive(command.velocity)
        return False


class MoveSlowAndClear(Recovery):
    """move_slow_and_clear/MoveSlowAndClear: forgets what is near, and drives slowly for a while."""

    TABLE = "move_slow_and_clear"

    def step(self) -> bool:
        values, context = self.values, self.context
        rospy.logwarn("Move slow and clear recovery behavior started.")
        for costmap in (context.global_costmap, context.local_costmap):
            costmap.clear_area(2 * values["clearing_distance"], None, True)
        context.base.limit(values["limited_trans_speed"], values["limited_rot_speed"],
                       values["limited_distance"])
        return True


class Escape(Recovery):
    """car_planner/EscapeRecovery: slowly back, or forwards, to where there is more room; ours."""

    TABLE = "escape_recovery"

    def start(self, context: RecoveryContext) -> None:
        super().start(context)
        self._command: recovery.Command | None = None

    def step(self) -> bool:
        costmap, pose = self.context.local_costmap, self.context.local_costmap.robot_pose()
        if pose is None:
            return False
        snapshot = costmap.snapshot()
        if self._command is None:
            self._command = recovery.escape(snapshot, costmap.footprint, pose,
                                            settings_from(recovery.EscapeSettings, self.values))
            if self._command is None:
                rospy.logerr("%s can't move: there is no room ahead or behind.", self.name)
                return True
            self._steps_left = int(TOO_LONG * self.values["distance"] / self.values["speed"]
                                   * self.context.frequency)
        way = self._command.trajectory
        at = int(np.hypot(*(way[:, :2] - pose[:2]).T).argmin())
        outlines = footprints.to_leave_with(snapshot, costmap.footprint, pose)
        self._steps_left -= 1
        if at == len(way) - 1 or not self._steps_left or not any(
                (footprints.costs(snapshot, outline, way[at + 1:]) >= 0).all()
                for outline in outlines):
            self.context.base.stop()
            return True
        self.context.base.drive(self._command.velocity)
        return False


RECOVERIES = {
    "clear_costmap_recovery/ClearCostmapRecovery": ClearCostmap,
    "rotate_recovery/RotateRecovery": Rotate,
    "move_slow_and_clear/MoveSlowAndClear": MoveSlowAndClear,
    "car_planner/EscapeRecovery": Escape,
}
DEFAULT = (("conservative_reset", ClearCostmap), ("rotate_recovery", Rotate),
           ("aggressive_reset", ClearCostmap), ("rotate_recovery", Rotate))
OURS = (("conservative_reset", ClearCostmap), ("escape", Escape), ("rotate_recovery", Rotate),
        ("aggressive_reset", ClearCostmap), ("escape", Escape), ("rotate_recovery", Rotate))


def load(values: dict[str, Any], circumscribed_radius: float) -> list[Recovery]:
    """The behaviours of `~recovery_behaviors`, or the default ones; `values` are move_base's.

    Ours have Escape before each turn, for a robot that touches something and cannot turn; a car,
    which never can, has them without the turns. Raises ParameterError for invalid parameters of
    theirs and for unknown types.
    """
    where = rospy.resolve_name("~recovery_behaviors")
    wanted = values["recovery_behaviors"]
    if wanted and _is_list_of_behaviours(wanted):
        return [chosen(entry["type"], RECOVERIES, f"type of {entry['name']} in {where}")(
            entry["name"]) for entry in wanted]
    rospy.set_param("~conservative_reset/reset_distance", values["conservative_reset_dist"])
    rospy.set_param("~aggressive_reset/reset_distance", 4 * circumscribed_radius)
    is_car = values["command_type"] == "ackermann"
    turns = values["clearing_rotation_allowed"] and not is_car
    return [kind(name) for name, kind in (OURS if is_car or values["escape_allowed"] else DEFAULT)
            if kind is not Rotate or turns]


def _is_list_of_behaviours(wanted: list) -> bool:
    """Whether the list is valid; if not, logs a line in upstream's words."""
    names = [entry.get("name") for entry in wanted
             if isinstance(entry, dict) and isinstance(entry.get("type"), str)
             and isinstance(entry.get("name"), str)]
    if len(names) < len(wanted):
        rospy.logerr("Recovery behaviors must have a name and a type and this does not. "
                     "Using the default recovery behaviors instead.")
        return False
    for name in names:
        if names.count(name) > 1:
            rospy.logerr("A recovery behavior with the name %s already exists, this is not "
                         "allowed. Using the default recovery behaviors instead.", name)
            return False
    return True
