"""Shapes of visuals and collisions; lengths in m."""

from __future__ import annotations

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


@dataclass(frozen=True)
class Box:
    """A cuboid, centred."""

    size: Vector3  # full lengths


@dataclass(frozen=True)
class Cylinder:
    """A cylinder, centred."""

    radius: float
    length: float  # along z, centred


@dataclass(frozen=True)
class Sphere:
    """A ball, centred."""

    radius: float


@dataclass(frozen=True)
class Plane:
    """An infinite plane."""

    normal: Vector3
    size: tuple[float, float]  # the part that is drawn; a plane collides everywhere


@dataclass(frozen=True)
class Mesh:
    """Triangles from a file, or from one part of it."""

    path: str  # absolute path of an existing file
    scale: Vector3 = (1.0, 1.0, 1.0)
    submesh: str | None = None
    centre_submesh: bool = False


@dataclass(frozen=True)
class Heightmap:
    """Terrain with heights from a grey image: white is `size[2]` above black; image up is +y."""

    path: str | None  # absolute path of an existing image; None: flat
    size: Vector3 = (1.0, 1.0, 1.0)
    position: Vector3 = (0.0, 0.0, 0.0)  # of the middle of the black level, in the link frame
    layers: tuple[TerrainLayer, ...] = ()  # from the lowest up


@dataclass(frozen=True)
class TerrainLayer:
    """The look of a heightmap from some height on."""

    material: Material
    tile: float = 10.0  # m that one image of the texture covers
    lowest: float = 0.0  # m above the black level


@dataclass(frozen=True)
class Polyline:
    """Outlines extruded upwards from z = 0; points inside an odd number of them are solid."""

    outlines: tuple[tuple[tuple[float, float], ...], ...]  # closed, m
    height: float = 1.0


@dataclass(frozen=True)
class ImageExtrusion:
    """The dark parts of an image as walls from z = 0 up; the image's centre is the origin."""

    path: str  # absolute path of an existing image
    scale: float = 1.0  # m/px
    threshold: int = 200  # grey value (0..255) up to which a pixel is solid
    height: float = 1.0


@dataclass(frozen=True)
class Strip:
    """A band of ground along points, such as a road; it is only drawn."""

    points: tuple[Vector3, ...]
    width: float = 1.0


Generated = Heightmap | Polyline | ImageExtrusion | Strip  # triangles that are made here
Geometry = Box | Cylinder | Sphere | Plane | Mesh | Generated
