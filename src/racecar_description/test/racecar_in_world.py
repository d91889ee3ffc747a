"""The car in the simulator's core, with the PID controllers of its YAML worked out here."""

import math
from pathlib import Path

import yaml

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xacro.files import expand
from bullet_sim.pose import Pose
from bullet_sim.world import World

PACKAGE = Path(__file__).resolve().parent.parent
WHEELBASE, TRACK, WHEEL_RADIUS = 0.335, 0.23, 0.05  # m
MIDDLE = (1.0, 3.2)  # m, of the field inside the walls of racetrack.world
RESOURCES = Resources.from_environment(
    extra_model_paths=[PACKAGE / "models"], extra_resource_paths=[PACKAGE],
    find_package=lambda name: str(PACKAGE))
AXLES = ("left_rear_axle", "right_rear_axle", "left_front_axle", "right_front_axle")
HINGES = ("left_steering_joint", "right_steering_joint")


def controllers() -> dict:
    """Joint -> controller of config/controller_racecar.yaml."""
    text = (PACKAGE / "config" / "controller_racecar.yaml").read_text(encoding="utf-8")
    entries = yaml.safe_load(text)["racecar"].values()
    return {entry["joint"]: entry for entry in entries if "joint" in entry}


class PidJoint:
    """One effort controller: its error is a rate's for an axle, an angle's for a hinge."""

    def __init__(self, joint, controller: dict):
        self.command = 0.0  # rad/s or rad
        self.measured = 0.0  # the same
        self._joint = joint
        self._steers = controller["type"].endswith("JointPositionController")
        self._gains = controller["pid"]
        self._error_before: float | None = None

    def update(self, period: float) -> None:
        """Read the joint, and drive it during the next step; period in s."""
        self.measured = self._joint.position if self._steers else self._joint.velocity
        error = self.command - self.measured
        before = error if self._error_before is None else self._error_before
        self._error_before = error
        effort = self._gains["p"] * error + self._gains["d"] * (error - before) / period
        limit = self._joint.description.effort
        self._joint.drive_effort(min(max(effort, -limit), limit))


class Car:
    """A car in a world, driven by wheel rates and hinge angles."""

    def __init__(self, world_name: str = "racetrack", pose: Pose | None = None):
        self.world = World(load_world(PACKAGE / "worlds" / f"{world_name}.world", RESOURCES))
        text = expand(PACKAGE / "urdf" / "racecar.urdf.xacro")
        self.model = self.world.spawn(load_model(text, RESOURCES), pose or at(0.0, -3.2), "racecar")
        self.joints = {name: PidJoint(self.model.joint(name), controller)
                       for name, controller in controllers().items()}
        self.history: list[dict[str, float]] = []  # of each step: what every joint measured

    def run(self, seconds: float) -> None:
        """Let time pass with the commands as they are."""
        for _ in range(round(seconds / self.world.timestep)):
            for joint in self.joints.values():
                joint.update(self.world.timestep)
            self.world.step()
            self.history.append({name: joint.measured for name, joint in self.joints.items()})

    def wheels(self, rate: float) -> None:
        """All four wheels at one rate, rad/s."""
        for name in AXLES:
            self.joints[name].command = rate

    def drive(self, speed: float, steering: float) -> None:
        """Ackermann: m/s and the bicycle model's angle (rad) at the middle of the rear axle.

        Every wheel rolls on a circle round one point on the rear axle's line, without slip.
        """
        curvature = math.tan(steering) / WHEELBASE
        for side, y in (("left", TRACK / 2), ("right", -TRACK / 2)):
            rear = 1 - curvature * y  # this wheel's speed in parts of the car's
            angle = math.atan2(curvature * WHEELBASE, rear)
            self.joints[f"{side}_steering_joint"].command = angle
            self.joints[f"{side}_rear_axle"].command = speed * rear / WHEEL_RADIUS
            front = math.hypot(rear, curvature * WHEELBASE)
            self.joints[f"{side}_front_axle"].command = speed * front / WHEEL_RADIUS

    def speed(self) -> float:
        """m/s over the ground."""
        return math.hypot(*self.model.twist.linear[:2])


def at(x: float, y: float, yaw: float = 0.0) -> Pose:
    """A place on the ground, m and rad from the middle of the field."""
    return Pose.from_xyz_rpy((x + MIDDLE[0], y + MIDDLE[1], 0.0), (0.0, 0.0, yaw))
