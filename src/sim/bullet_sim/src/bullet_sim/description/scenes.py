"""What is drawn besides the models: lights, fog, sky and background."""

from dataclasses import dataclass

from bullet_sim.description.shapes import Rgba
from bullet_sim.pose import IDENTITY, Pose, Vector3


@dataclass(frozen=True)
class LightDescription:
    """A light; poses in the world, or in the frame of the link that carries it."""

    name: str
    type: str = "point"  # point, directional, spot
    pose: Pose = IDENTITY
    diffuse: Rgba = (1.0, 1.0, 1.0, 1.0)
    specular: Rgba = (0.1, 0.1, 0.1, 1.0)
    direction: Vector3 = (0.0, 0.0, -1.0)
    cast_shadows: bool = False
    range: float = 10.0
    constant: float = 1.0
    linear: float = 1.0
    quadratic: float = 0.0
    inner_angle: float = 0.0
    outer_angle: float = 0.0
    falloff: float = 0.0


@dataclass(frozen=True)
class Fog:
    """Blends in a colour by depth z (m): fully from `end` on, or 1 - e^-z, 1 - e^-z^2."""

    type: str = "none"  # none, linear, exp, exp2
    colour: Rgba = (1.0, 1.0, 1.0, 1.0)
    start: float = 1.0  # m, of linear
    end: float = 100.0  # m, of linear
    density: float = 1.0  # 1/m, of exp and exp2


@dataclass(frozen=True)
class SceneDescription:
    """The surroundings of everything that is drawn."""

    ambient: Rgba = (0.4, 0.4, 0.4, 1.0)
    background: Rgba = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    sky: bool = False
    fog: Fog = Fog()
