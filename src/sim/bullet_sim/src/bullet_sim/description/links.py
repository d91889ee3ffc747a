"""Links: mass, visuals, collisions, and what is mounted on them."""

from dataclasses import dataclass

from bullet_sim.description.plugins import PluginDescription
from bullet_sim.description.scenes import LightDescription
from bullet_sim.description.sensors import SensorDescription
from bullet_sim.description.shapes import Geometry
from bullet_sim.description.surfaces import Material, Surface
from bullet_sim.pose import IDENTITY, Pose


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
