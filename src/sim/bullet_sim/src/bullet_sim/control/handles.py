"""A controller's access to a joint: its state, and its command."""

from dataclasses import dataclass

from bullet_sim.description import JointLimits

INTERFACES = ("effort", "position", "velocity")


@dataclass(slots=True, eq=False)
class JointHandle:
    """State of one joint, updated by the hardware before the controllers."""

    name: str
    type: str  # revolute, continuous or prismatic
    limits: JointLimits = JointLimits()
    position: float = 0.0  # rad or m; a continuous joint counts its turns
    velocity: float = 0.0  # rad/s or m/s
    effort: float = 0.0  # N m or N, of its motor in the last step


@dataclass(slots=True, eq=False)
class CommandHandle:
    """A joint's command; the hardware applies it at every step, within the limits."""

    joint: JointHandle
    interface: str  # one of INTERFACES
    command: float = 0.0  # N m or N, rad or m, rad/s or m/s

    def rest(self) -> None:
        """No effort, no speed, or the joint's current position."""
        self.command = self.joint.position if self.interface == "position" else 0.0
