"""Models: links with their surfaces, joints, and plugins."""

import math
from dataclasses import dataclass, field

from bullet_sim.description.scenes import LightDescription
from bullet_sim.description.sensors import PluginDescription, SensorDescription
from bullet_sim.description.shapes import Geometry, Material, Surface
from bullet_sim.pose import IDENTITY, Pose, Vector3


@dataclass(frozen=True)
class Inertial:
    """Mass of a link, and its distribution."""

    mass: float = 1.0
    pose: Pose = IDENTITY  # centre of mass and axes of the tensor, in the link frame
    inertia: tuple[float, float, float, float, float, float] = (1.0, 0.0, 0.0, 1.0, 0.0, 1.0)
    # ixx, ixy, ixz, iyy, iyz, izz in kg m^2, about the centre of mass


@dataclass(frozen=True)
class Visual:
    """A visible part of a link."""

    name: str
    geometry: Geometry
    pose: Pose = IDENTITY  # in the link frame
    material: Material | None = None  # None: the mesh's own, else Gazebo's default
    transparency: float = 0.0  # 0 opaque, 1 invisible
    cast_shadows: bool = True
    plugins: tuple[PluginDescription, ...] = ()


@dataclass(frozen=True)
class Collision:
    """A part of a link that collides with others."""

    name: str
    geometry: Geometry
    pose: Pose = IDENTITY  # in the link frame
    surface: Surface = Surface()
    laser_retro: float = 0.0


@dataclass(frozen=True)
class LinkDescription:
    """A rigid part of a model."""

    name: str
    pose: Pose = IDENTITY  # in the model frame, joints at zero
    inertial: Inertial = Inertial()
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    sensors: tuple[SensorDescription, ...] = ()
    lights: tuple[LightDescription, ...] = ()  # poses in the link frame
    gravity: bool = True
    kinematic: bool = False
    self_collide: bool = False
    linear_damping: float = 0.0
    angular_damping: float = 0.0


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


@dataclass(frozen=True)
class Trajectory:
    """The way of an actor, regardless of obstacles: straight between waypoints."""

    waypoints: tuple[tuple[float, Pose], ...]  # s since the start and pose in the world, in order
    loop: bool = True
    delay_start: float = 0.0  # s, before every round
    auto_start: bool = True


@dataclass(frozen=True)
class ModelDescription:
    """Links connected by joints, with the plugins that drive and read them."""

    name: str
    pose: Pose = IDENTITY  # in the world
    static: bool = False
    self_collide: bool = False
    auto_disables: bool = True  # <allow_auto_disable>: links that hardly move are held still
    links: tuple[LinkDescription, ...] = ()
    joints: tuple[JointDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    child_models: tuple[str, ...] = ()  # names of nested models; their links are named nested::link
    child_poses: dict[str, Pose] = field(default_factory=dict)  # of nested models in this one
    lumped: dict[str, tuple[str, Pose]] = field(default_factory=dict)
    # link removed by fixed-joint lumping -> (surviving link, pose in that link's frame)
    trajectory: Trajectory | None = None  # of an actor
