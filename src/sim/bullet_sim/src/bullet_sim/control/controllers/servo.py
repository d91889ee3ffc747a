"""A PID from a joint's position or velocity error to its command: effort or velocity."""

from abc import ABC, abstractmethod
from collections.abc import Sequence

from bullet_sim.control.controllers.commands import Commands
from bullet_sim.control.handles import CommandHandle
from bullet_sim.control.joint_motors import position_error
from bullet_sim.control.limits import clamp
from bullet_sim.control.pid import Pid


class Servo(ABC):
    """One joint; `target`, `error` and `output` are those of the last update."""

    def __init__(self, handle: CommandHandle, pid: Pid):
        self.handle = handle
        self.pid = pid
        self.target = self.error = self.output = 0.0

    def start(self) -> float:
        """Forget the past; returns the target to begin with."""
        self.pid.reset()
        return self.rest()

    @abstractmethod
    def rest(self) -> float:
        """The target that keeps the joint as it is."""

    @property
    @abstractmethod
    def process_value(self) -> float:
        """The value that should reach the target."""

    @abstractmethod
    def update(self, target: float, period: float) -> None:
        """Write the command; `period` (s) since the last update."""


class VelocityServo(Servo):
    """Targets in rad/s or m/s."""

    def rest(self) -> float:
        """Zero speed."""
        return 0.0

    @property
    def process_value(self) -> float:
        """rad/s or m/s."""
        return self.handle.joint.velocity

    def update(self, target: float, period: float) -> None:
        """Write the command; `period` (s) since the last update."""
        self.target = target
        self.error = target - self.handle.joint.velocity
        self.output = self.handle.command = self.pid.compute(self.error, period)


class PositionServo(Servo):
    """Targets in rad or m, kept within the joint's limits; continuous joints turn the short way."""

    def rest(self) -> float:
        """The joint's position."""
        return self.handle.joint.position

    @property
    def process_value(self) -> float:
        """rad or m."""
        return self.handle.joint.position

    def update(self, target: float, period: float) -> None:
        """Write the command; `period` (s) since the last update."""
        joint = self.handle.joint
        if joint.type != "continuous":
            target = clamp(target, joint.limits.lower, joint.limits.upper)
        self.target = target
        self.error = position_error(joint, target)
        self.output = self.handle.command = self.pid.compute(self.error, period)


TYPES: dict[str, tuple[str, type[Servo], bool]] = {  # interface, control law, is group
    "effort_controllers/JointPositionController": ("effort", PositionServo, False),
    "effort_controllers/JointVelocityController": ("effort", VelocityServo, False),
    "velocity_controllers/JointPositionController": ("velocity", PositionServo, False),
    "effort_controllers/JointGroupPositionController": ("effort", PositionServo, True),
}


class Servos:
    """One target per joint. A velocity falls back to 0 after a time-out, a position is held."""

    def __init__(self, servos: Sequence[Servo], timeout: float = 0.0):
        self.servos = servos
        self.commands = Commands(timeout)

    def start(self) -> None:
        """Keep everything as it is until a command comes."""
        rest = [servo.start() for servo in self.servos]
        holds = any(isinstance(servo, PositionServo) for servo in self.servos)
        self.commands.start(rest, None if holds else rest)

    def update(self, time: float, period: float) -> None:
        """Write the commands."""
        for servo, target in zip(self.servos, self.commands.at(time), strict=True):
            servo.update(target, period)
