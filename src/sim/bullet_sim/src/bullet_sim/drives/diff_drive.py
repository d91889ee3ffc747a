"""Differential drive: two velocity motors, with a limit on wheel acceleration."""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass

from bullet_sim.errors import SimulationError
from bullet_sim.joint import Joint
from bullet_sim.model import Model
from bullet_sim.plugin_tags import LoggedParameters, PluginParameters
from bullet_sim.pose import Pose, rotate
from bullet_sim.twist import add, dot, negative

log = logging.getLogger("bullet_sim.plugins")

SETTLED = 0.01  # m/s: closer to the target than this, the command jumps to it


@dataclass(frozen=True)
class DiffDriveParameters:
    """Geometry and motors; defaults are those of gazebo_ros_diff_drive.cpp, Load.

    As there, a negative separation reverses turns, and a negative diameter reverses everything.
    """

    wheel_separation: float = 0.34  # m
    wheel_diameter: float = 0.15  # m
    wheel_acceleration: float = 0.0  # m/s^2 at the rim; 0: immediate
    wheel_torque: float = 5.0  # N m

    @classmethod
    def from_tags(cls, tags: PluginParameters | LoggedParameters) -> DiffDriveParameters:
        """Read from the tags of libgazebo_ros_diff_drive.so; PluginError if they are wrong."""
        return cls(
            tags.number("wheelSeparation", 0.34), tags.number("wheelDiameter", 0.15),
            tags.number("wheelAcceleration", 0.0), tags.number("wheelTorque", 5.0))


def wheels_from_tags(model: Model, tags: PluginParameters | LoggedParameters
                     ) -> tuple[Joint, Joint]:
    """The joints of the left and the right wheel, by tags; UnknownName if there is none."""
    left, right = tags.text("leftJoint", "left_joint"), tags.text("rightJoint", "right_joint")
    return model.joint(left), model.joint(right)


def driven_wheels(model: Model, wheels: tuple[Joint, Joint], parameters: DiffDriveParameters,
                  tags: PluginParameters, label: str) -> tuple[Joint, Joint]:
    """The wheels that are driven as left and right: swapped for files from before Melodic.

    Indigo to Lunar swapped them unless <legacyMode> was false, so files of that time call the
    right wheel left. Noetic, which does not read the tag, turns such robots the wrong way.
    `label` begins the warning of a swap.
    """
    left, right = wheels
    if not tags.flag("legacyMode", True) or not turns_backwards(
            *((joint, model.links[joint.description.child].pose) for joint in wheels), parameters):
        return left, right
    log.warning("%s: <leftJoint> %s is the right wheel, seen where it drives to: taken as "
                "written for Indigo to Lunar, whose <legacyMode> swapped the two; for the "
                "behaviour of Melodic and Noetic write <legacyMode>false</legacyMode>",
                label, left.name)
    return right, left


class DiffDrive:
    """Turns (forward, yaw rate) into motor targets; call `update` at the drive's own rate.

    SimulationError for a diameter or separation of 0.
    """

    def __init__(self, left: Joint, right: Joint, parameters: DiffDriveParameters):
        if not parameters.wheel_diameter or not parameters.wheel_separation:
            raise SimulationError(
                f"wheel diameter {parameters.wheel_diameter} and separation "
                f"{parameters.wheel_separation} must not be 0 m")
        self._left, self._right = left, right
        self._parameters = parameters
        self.stop()

    def command(self, forward: float, yaw_rate: float) -> None:
        """Set the wanted speed (m/s) and yaw rate (rad/s); held until the next command."""
        half = yaw_rate * self._parameters.wheel_separation / 2
        self._wanted = (forward - half, forward + half)

    def stop(self) -> None:
        """Forget command and ramp."""
        self._wanted = (0.0, 0.0)
        self._commanded = (0.0, 0.0)

    def update(self, elapsed: float) -> None:
        """Move the motor targets towards the command; `elapsed` in s since the last update."""
        p = self._parameters
        self._commanded = ramp(self._commanded, self._wanted, p.wheel_acceleration * elapsed)
        radius = p.wheel_diameter / 2
        for joint, speed in zip((self._left, self._right), self._commanded, strict=True):
            joint.drive_velocity(speed / radius, p.wheel_torque)


def turns_backwards(left: tuple[Joint, Pose], right: tuple[Joint, Pose],
                    parameters: DiffDriveParameters) -> bool:
    """Whether a positive yaw rate would turn right: "left" is the right wheel.

    Each joint comes with the pose of its child link. A wheel that turns about an axis drives so
    that the axis points to the left, so the left wheel is further along the axis.
    """
    across = add(left[1].position, negative(right[1].position))
    sense = math.copysign(1.0, parameters.wheel_separation * parameters.wheel_diameter)
    return all(sense * dot(_axis(*wheel), across) < 0 for wheel in (left, right))


def _axis(joint: Joint, link: Pose) -> tuple[float, float, float]:
    turn = (link * joint.description.pose).orientation
    return rotate(turn, joint.description.axis)


def ramp(now: tuple[float, float], wanted: tuple[float, float],
         step: float) -> tuple[float, float]:
    """Rim speeds after one update. If `step` is 0, or one wheel is there already, set at once."""
    gaps = [w - n for n, w in zip(now, wanted, strict=True)]
    if step <= 0 or min(abs(gap) for gap in gaps) < SETTLED:
        return wanted
    return tuple(n + max(-step, min(step, gap)) for n, gap in zip(now, gaps, strict=True))
