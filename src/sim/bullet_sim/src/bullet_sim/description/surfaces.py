"""The look of surfaces and their contact: colours, textures, contact parameters."""

from dataclasses import dataclass

from bullet_sim.pose import Vector3

Rgba = tuple[float, float, float, float]  # each 0..1


@dataclass(frozen=True)
class Material:
    """Colours and texture of a visual; a texture multiplies the diffuse colour."""

    ambient: Rgba = (1.0, 1.0, 1.0, 1.0)
    diffuse: Rgba = (1.0, 1.0, 1.0, 1.0)
    specular: Rgba = (0.0, 0.0, 0.0, 1.0)
    emissive: Rgba = (0.0, 0.0, 0.0, 1.0)
    shininess: float = 0.0
    texture: str | None = None  # absolute path of an existing file
    texture_scale: tuple[float, float] = (1.0, 1.0)  # OGRE's: 2 shows the image twice as large
    lighting: bool = True
    double_sided: bool = False


@dataclass(frozen=True)
class Surface:
    """Contact parameters, with SDF's defaults (an infinite ODE `fdir1` is 0 0 0)."""

    mu: float = 1.0
    mu2: float = 1.0
    fdir1: Vector3 = (0.0, 0.0, 0.0)
    kp: float = 1e12  # N/m
    kd: float = 1.0  # N s/m
    min_depth: float = 0.0
    max_vel: float = 0.01  # m/s
    restitution: float = 0.0
    collide_bitmask: int = 0xFFFF  # two collide if they have a bit in common
    collides: bool = True  # false: <collide_without_contact>
