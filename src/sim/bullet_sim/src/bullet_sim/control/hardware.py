"""A model's joints for ros_control: read, and driven within their limits.

The semantics are those of gazebo_ros_control's default_robot_hw_sim.cpp: one interface per joint.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.joint_motors import EffortMotor, make_motor
from bullet_sim.control.parameters import ControllerParameters
from bullet_sim.control.pid import PidGains
from bullet_sim.description import JointLimits
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.formats.urdf.transmission import Transmission
from bullet_sim.joint import Joint
from bullet_sim.model import Model

NO_LIMITS = JointLimits()
GAINS = "gazebo_ros_control/pid_gains"
LIMITS = "joint_limits"
# what joint_limits_interface reads: kind of limit -> its fields here, and the parameters
KINDS = {"position": (("lower", "min_position"), ("upper", "max_position")),
         "velocity": (("velocity", "max_velocity"),),
         "acceleration": (("acceleration", "max_acceleration"),),
         "effort": (("effort", "max_effort"),)}


class RobotHardware:
    """Handles of all joints that have a transmission, by name. Used in the loop's thread only.

    SimulationError for a transmission of a joint that the model does not have.
    """

    def __init__(self, model: Model, transmissions: Iterable[Transmission],
                 limits: Mapping[str, JointLimits], gains: Mapping[str, PidGains]):
        self.model_name = model.name
        self.joints: dict[str, JointHandle] = {}
        self._handles: dict[str, CommandHandle] = {}
        for transmission in transmissions:
            name = transmission.joint
            kind = _joint(model, name).description.type
            self.joints[name] = JointHandle(name, kind, limits.get(name, NO_LIMITS))
            self._handles[name] = CommandHandle(self.joints[name], transmission.interface)
        drives = {name: make_motor(handle, gains.get(name), model.joint(name))
                  for name, handle in self._handles.items()}
        self._drives = list(drives.values())
        self._motors = [drive for drive in self._drives if not isinstance(drive, EffortMotor)]
        by_effort = [name for name, drive in drives.items() if isinstance(drive, EffortMotor)]
        by_motor = [name for name in drives if name not in by_effort]
        self._effort_groups = [
            (group, [self.joints[name] for name in group.names],
             [drives[name] for name in group.names])
            for group in model.joint_groups(by_effort)
        ]
        self._motor_groups = [(group, [self.joints[name] for name in group.names])
                              for group in model.joint_groups(by_motor)]
        self._held: list[tuple[CommandHandle, float]] = []  # during an emergency stop
        self.read()
        for handle in self._handles.values():
            handle.rest()

    # --- at each step

    def read(self) -> None:
        """Update the state of all joints from the engine."""
        for group, joints, _ in self._effort_groups:
            for joint, row in zip(joints, group.states(), strict=True):
                joint.position, joint.velocity, _, _ = row
        for group, joints in self._motor_groups:
            for joint, row in zip(joints, group.states(), strict=True):
                joint.position, joint.velocity, _, joint.effort = row

    def write(self, period: float) -> None:
        """Pass the commands, within the limits, to the engine for the next step.

        `period` (s) is the time since the last write.
        """
        for handle in self._handles.values():
            if handle.command != handle.command:  # NaN: must not reach the engine
                handle.rest()
        for handle, command in self._held:
            handle.command = command
        for group, _, drives in self._effort_groups:
            group.drive_efforts([drive.effort(period) for drive in drives])
        for motor in self._motors:
            motor.drive(period)

    def stop(self, on: bool) -> None:
        """Emergency stop: no effort, no speed, positions held, whatever is commanded."""
        if on and not self._held:
            for handle in self._handles.values():
                handle.rest()
            self._held = [(handle, handle.command) for handle in self._handles.values()]
        elif not on:
            self._held = []

    def reset(self) -> None:
        """After a reset of joints: forget earlier states."""
        for drive in self._drives:
            drive.reset()

    # --- for controllers

    def joint_handle(self, name: str) -> JointHandle:
        """The state of a joint. UnknownName if there is none of that name."""
        if name not in self.joints:
            raise UnknownName(f"joint with a transmission in model {self.model_name}", name,
                              self.joints)
        return self.joints[name]

    def command_handle(self, interface: str, joint: str) -> CommandHandle:
        """The handle of a joint's command.

        UnknownName without such a joint, SimulationError if it takes other commands.
        """
        self.joint_handle(joint)
        handle = self._handles[joint]
        if handle.interface == interface:
            return handle
        fitting = [name for name, other in self._handles.items() if other.interface == interface]
        raise SimulationError(
            f"joint {joint!r} takes {handle.interface} commands, not {interface} commands, as its "
            f"transmission says; joints that take {interface} commands: "
            f"{', '.join(fitting) or 'none'}")


def open_hardware(model: Model, robot: RobotFacts, transmissions: Sequence[Transmission],
                  parameters: ControllerParameters) -> RobotHardware:
    """A model's joints with the limits and gains of its URDF and of the parameters.

    PluginError for a parameter of the wrong type, SimulationError for a joint that does not exist.
    """
    joints = [transmission.joint for transmission in transmissions]
    return RobotHardware(model, transmissions, read_joint_limits(parameters, robot, joints),
                         read_joint_gains(parameters, joints))


def _joint(model: Model, name: str) -> Joint:
    if name not in model.joints:
        raise SimulationError(
            f'This robot has a joint named "{name}" which is not in the gazebo model. There are: '
            f"{', '.join(model.joints) or 'none'}")
    return model.joints[name]


def read_joint_limits(parameters: ControllerParameters, robot: RobotFacts,
                      joints: Iterable[str]) -> dict[str, JointLimits]:
    """The URDF's limits, overridden by `joint_limits/<joint>/...`."""
    parameters = parameters.group(LIMITS)
    return {
        joint: _overridden(robot.limits(joint) if robot.has_joint(joint) else JointLimits(),
                           parameters, joint)
        for joint in joints
    }


def _overridden(limits: JointLimits, parameters: ControllerParameters, joint: str) -> JointLimits:
    for kind, pairs in KINDS.items():
        switch = f"{joint}/has_{kind}_limits"
        if not parameters.has(switch):
            continue
        for key, name in pairs:
            value = getattr(JointLimits, key)  # no limit
            if parameters.flag(switch):
                value = parameters.number(f"{joint}/{name}")
            limits = replace(limits, **{key: value})
    return limits


def read_joint_gains(parameters: ControllerParameters,
                     joints: Iterable[str]) -> dict[str, PidGains]:
    """The gains of those joints that have any; the others are driven without a PID."""
    parameters = parameters.group(GAINS)
    return {joint: PidGains.from_parameters(parameters, joint) for joint in joints
            if parameters.has(f"{joint}/p")}
