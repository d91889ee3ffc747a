"""Worlds: physics, location on Earth, scene and everything in them at the start."""

from dataclasses import dataclass

from bullet_sim.description.models import ModelDescription, Visual
from bullet_sim.description.scenes import LightDescription, SceneDescription
from bullet_sim.description.sensors import PluginDescription
from bullet_sim.pose import Vector3


@dataclass(frozen=True)
class PhysicsDescription:
    """`<physics>` with SDF's defaults; the ODE numbers are kept for get_physics_properties."""

    max_step_size: float = 0.001  # s
    real_time_update_rate: float = 1000.0  # Hz; 0: as fast as possible
    real_time_factor: float = 1.0
    max_contacts: int = 20
    iterations: int = 50
    precon_iterations: int = 0
    sor: float = 1.3
    cfm: float = 0.0
    erp: float = 0.2
    contact_max_correcting_vel: float = 100.0
    contact_surface_layer: float = 0.001
    auto_disable_bodies: bool = False
    # <bullet><solver><residual>, not of SDF, m^2/s^2: every step is solved until no row of an
    # iteration changes by more than its root. None: as PhysicsClient chooses.
    residual: float | None = None


@dataclass(frozen=True)
class SphericalDescription:
    """`<spherical_coordinates>`: the location of the world's origin on Earth."""

    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    elevation: float = 0.0  # m above the WGS84 ellipsoid
    heading_deg: float = 0.0  # from east to the world's x axis, counter-clockwise


@dataclass(frozen=True)
class WorldDescription:
    """The content of a world at the start; magnetic field in T, gravity in m/s^2."""

    name: str = "default"
    gravity: Vector3 = (0.0, 0.0, -9.8)
    magnetic_field: Vector3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    physics: PhysicsDescription = PhysicsDescription()
    scene: SceneDescription = SceneDescription()
    spherical: SphericalDescription | None = None
    models: tuple[ModelDescription, ...] = ()
    lights: tuple[LightDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    scenery: tuple[tuple[str, Visual], ...] = ()  # visible without collisions, such as roads
    sim_time: float = 0.0  # s, at which a saved world continues
