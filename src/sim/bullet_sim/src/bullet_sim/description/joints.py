"""Joints between links: axes, limits, losses and springs; limits of their controllers."""

import math
from dataclasses import dataclass

from bullet_sim.pose import IDENTITY, Pose, Vector3


@dataclass(frozen=True, kw_only=True)
class JointAxis:
    """`axis` is in the joint frame; for URDF that is the child link's frame (`pose` identity)."""

    axis: Vector3 = (0.0, 0.0, 1.0)
    lower: float = -1e16  # rad or m
    upper: float = 1e16
    effort: float = -1.0  # N m or N; negative: no limit
    velocity: float = -1.0  # rad/s or m/s; negative: no limit
    damping: float = 0.0
    friction: float = 0.0
    spring_reference: float = 0.0
    spring_stiffness: float = 0.0


@dataclass(frozen=True)
class JointDescription(JointAxis):
    """A joint between two links, with the fields of its first axis."""

    name: str
    type: str  # revolute, continuous, prismatic, fixed, ball, universal, revolute2, screw, gearbox
    parent: str  # link name, or "world"
    child: str
    pose: Pose = IDENTITY  # joint frame in the child link frame
    provide_feedback: bool = False
    axis2: JointAxis = JointAxis()  # of a universal, revolute2 or gearbox joint
    thread_pitch: float = 1.0  # screw: rad/m with the opposite sign, travel = -angle / thread_pitch
    gearbox_ratio: float = 1.0  # gearbox: angle of the parent = -ratio * angle of the child, both
    gearbox_reference_body: str = ""  # measured from this link, about axis and axis2
    start: float = 0.0  # rad or m: its position in a saved world; a reset sets it to zero


@dataclass(frozen=True)
class SoftLimits:
    """URDF's `<safety_controller>`: the joint slows down before it reaches the hard limits."""

    lower: float = 0.0  # rad or m
    upper: float = 0.0
    k_position: float = 0.0  # allowed speed per rad (or m) left to a soft limit
    k_velocity: float = 0.0  # allowed effort per speed left to its limit


@dataclass(frozen=True)
class JointLimits:
    """Limits of a controller's commands. Infinity means no limit; zero is a limit, too."""

    lower: float = -math.inf  # rad or m
    upper: float = math.inf
    velocity: float = math.inf  # rad/s or m/s
    acceleration: float = math.inf  # rad/s^2 or m/s^2; applies to velocity commands
    effort: float = math.inf  # N m or N
    soft: SoftLimits | None = None

    @property
    def has_position(self) -> bool:
        """Whether the position is limited at all."""
        return self.lower > -math.inf or self.upper < math.inf
