"""A controller's access to a joint: its state to read, and a command to write."""

from bullet_sim.description import JointLimits

INTERFACES = ("effort", "position", "velocity")


class JointHandle:
    """State of one joint, refreshed by the hardware before controllers are updated."""

    __slots__ = ("name", "type", "position", "velocity", "effort", "limits")

    def __init__(self, name: str, kind: str, limits: JointLimits | None = None):
        self.name = name
        self.type = kind  # revolute, continuous or prismatic
        self.position = 0.0  # rad or m; a continuous joint counts its turns
        self.velocity = 0.0  # rad/s or m/s
        self.effort = 0.0  # N m or N, what its motor did in the last step
        self.limits = limits or JointLimits()


class CommandHandle:
    """A joint's command; the hardware applies it at every step, within the limits."""

    __slots__ = ("joint", "interface", "command")

    def __init__(self, joint: JointHandle, interface: str):
        self.joint = joint
        self.interface = interface  # one of INTERFACES
        self.command = 0.0  # N m or N, rad or m, rad/s or m/s

    def rest(self) -> None:
        """No effort, no speed, or the position the joint has now."""
        self.command = self.joint.position if self.interface == "position" else 0.0
