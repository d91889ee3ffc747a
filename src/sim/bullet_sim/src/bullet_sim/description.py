"""What a model or world file says, as plain data: no mesh is opened here and no physics is known.

All lengths in m, angles in rad, masses in kg. Link poses are in the model frame with every joint at
zero.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.etree.ElementTree import Element

from bullet_sim.pose import IDENTITY, Pose, Vector3

Rgba = tuple[float, float, float, float]  # each 0..1


# --- shapes

@dataclass(frozen=True)
class Box:
    size: Vector3  # full lengths


@dataclass(frozen=True)
class Cylinder:
    radius: float
    length: float  # along z, centred


@dataclass(frozen=True)
class Sphere:
    radius: float


@dataclass(frozen=True)
class Plane:
    normal: Vector3
    size: tuple[float, float]  # what is drawn; a plane collides everywhere


@dataclass(frozen=True)
class Mesh:
    path: str  # absolute path of an existing file
    scale: Vector3 = (1.0, 1.0, 1.0)
    submesh: str | None = None
    centre_submesh: bool = False


@dataclass(frozen=True)
class Heightmap:
    """Ground whose height is a grey image: white is `size[2]` above black; image up is +y."""

    path: str | None  # absolute path of an existing image; None: flat
    size: Vector3 = (1.0, 1.0, 1.0)
    position: Vector3 = (0.0, 0.0, 0.0)  # of the middle of the black level, in the link frame
    layers: tuple[TerrainLayer, ...] = ()  # from the lowest up


@dataclass(frozen=True)
class TerrainLayer:
    """How a heightmap looks from some height on."""

    material: Material
    tile: float = 10.0  # m that one image of the texture covers
    lowest: float = 0.0  # m above the black level


@dataclass(frozen=True)
class Polyline:
    """Outlines extruded from z = 0 up; what lies inside an odd number of them is solid."""

    outlines: tuple[tuple[tuple[float, float], ...], ...]  # closed, m
    height: float = 1.0


@dataclass(frozen=True)
class ImageExtrusion:
    """The dark parts of a picture as walls from z = 0 up; the picture's middle is the origin."""

    path: str  # absolute path of an existing image
    scale: float = 1.0  # m/px
    threshold: int = 200  # grey value (0..255) up to which a pixel is solid
    height: float = 1.0


@dataclass(frozen=True)
class Strip:
    """A band of ground along points, such as a road; it is only ever drawn."""

    points: tuple[Vector3, ...]
    width: float = 1.0


Generated = Heightmap | Polyline | ImageExtrusion | Strip  # triangles that we make ourselves
Geometry = Box | Cylinder | Sphere | Plane | Mesh | Generated


# --- surfaces

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
    collide_bitmask: int = 0xFFFF  # two meet where they have a bit in common
    collides: bool = True  # false: <collide_without_contact>


@dataclass(frozen=True)
class Visual:
    name: str
    geometry: Geometry
    pose: Pose = IDENTITY  # in the link frame
    material: Material | None = None  # None: the mesh's own, else Gazebo's default
    transparency: float = 0.0  # 0 opaque, 1 invisible
    cast_shadows: bool = True
    plugins: tuple[PluginDescription, ...] = ()


@dataclass(frozen=True)
class Collision:
    name: str
    geometry: Geometry
    pose: Pose = IDENTITY  # in the link frame
    surface: Surface = Surface()
    laser_retro: float = 0.0


# --- sensors and plugins

@dataclass(frozen=True)
class PluginDescription:
    """A `<plugin>` element as written; who loads it reads the parameters."""

    name: str
    filename: str
    element: Element


@dataclass(frozen=True)
class Noise:
    type: str = "none"  # none, gaussian or gaussian_quantized
    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0  # of an error drawn once; it may come out with either sign
    bias_stddev: float = 0.0
    precision: float = 0.0  # gaussian_quantized: readings are multiples of it


@dataclass(frozen=True)
class Lens:
    """A wide-angle lens, `<lens>`: r = c1 f fun(theta / c2 + c3), r = 1 half an image wide."""

    c1: float = 2.0  # these four make it stereographic, as SDF has it without <type>
    c2: float = 2.0
    c3: float = 0.0  # rad
    function: str = "tan"  # sin, tan or id
    f: float = 1.0
    scale_to_hfov: bool = True  # f is chosen so that the picture is <horizontal_fov> wide
    cutoff_angle: float = 1.5707  # rad from the axis
    env_texture_size: int = 256  # px, side of each of the pictures it is made from


@dataclass(frozen=True)
class CameraDescription:
    horizontal_fov: float = 1.047
    width: int = 320  # px
    height: int = 240  # px
    format: str = "R8G8B8"
    near: float = 0.1
    far: float = 100.0
    noise: Noise = Noise()
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)  # k1 k2 p1 p2 k3
    distortion_centre: tuple[float, float] = (0.5, 0.5)  # in parts of width and height
    lens: Lens = Lens()  # only wide-angle cameras look through it
    name: str = ""
    pose: Pose = IDENTITY  # in the sensor's frame


@dataclass(frozen=True)
class RayDescription:
    samples: int = 640
    resolution: float = 1.0
    min_angle: float = 0.0
    max_angle: float = 0.0
    vertical_samples: int = 1
    vertical_resolution: float = 1.0
    vertical_min_angle: float = 0.0
    vertical_max_angle: float = 0.0
    range_min: float = 0.0
    range_max: float = 0.0
    range_resolution: float = 0.0
    noise: Noise = Noise()


@dataclass(frozen=True)
class ImuDescription:
    """Noise of each axis: rad/s and m/s^2."""

    angular_velocity: tuple[Noise, Noise, Noise] = (Noise(), Noise(), Noise())
    linear_acceleration: tuple[Noise, Noise, Noise] = (Noise(), Noise(), Noise())


@dataclass(frozen=True)
class SensorDescription:
    """A sensor on a link. `cameras` has one entry for camera types, several for multicamera."""

    name: str
    type: str  # camera, depth, multicamera, ray, gpu_ray, imu, contact …
    pose: Pose = IDENTITY  # in the link frame
    update_rate: float = 0.0  # Hz; 0: as often as possible
    always_on: bool = False
    cameras: tuple[CameraDescription, ...] = ()
    ray: RayDescription | None = None
    imu: ImuDescription = ImuDescription()
    plugins: tuple[PluginDescription, ...] = ()
    element: Element | None = None


# --- models

@dataclass(frozen=True)
class Inertial:
    mass: float = 1.0
    pose: Pose = IDENTITY  # centre of mass and axes of the tensor, in the link frame
    inertia: tuple[float, float, float, float, float, float] = (1.0, 0.0, 0.0, 1.0, 0.0, 1.0)
    # ixx, ixy, ixz, iyy, iyz, izz in kg m^2, about the centre of mass


@dataclass(frozen=True)
class LinkDescription:
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


@dataclass(frozen=True)
class SecondAxis:
    """`<axis2>` of a universal, revolute2 or gearbox joint; fields as of JointDescription."""

    axis: Vector3 = (0.0, 0.0, 1.0)
    lower: float = -1e16
    upper: float = 1e16
    effort: float = -1.0
    velocity: float = -1.0
    damping: float = 0.0
    friction: float = 0.0
    spring_reference: float = 0.0
    spring_stiffness: float = 0.0


@dataclass(frozen=True)
class JointDescription:
    """`axis` is in the joint frame; for URDF that is the child link's frame (`pose` identity)."""

    name: str
    type: str  # revolute, continuous, prismatic, fixed, ball, universal, revolute2, screw, gearbox
    parent: str  # link name, or "world"
    child: str
    pose: Pose = IDENTITY  # joint frame in the child link frame
    axis: Vector3 = (0.0, 0.0, 1.0)
    lower: float = -1e16  # rad or m
    upper: float = 1e16
    effort: float = -1.0  # N m or N; below 0: no limit
    velocity: float = -1.0  # rad/s or m/s; below 0: no limit
    damping: float = 0.0
    friction: float = 0.0
    spring_reference: float = 0.0
    spring_stiffness: float = 0.0
    provide_feedback: bool = False
    axis2: SecondAxis = SecondAxis()
    thread_pitch: float = 1.0  # screw: rad/m with the sign turned, travel = -angle / thread_pitch
    gearbox_ratio: float = 1.0  # gearbox: angle of the parent = -ratio * angle of the child, both
    gearbox_reference_body: str = ""  # measured from this link, about axis and axis2


@dataclass(frozen=True)
class Trajectory:
    """Where an actor walks, whatever is in its way: straight from waypoint to waypoint."""

    waypoints: tuple[tuple[float, Pose], ...]  # s since the start and pose in the world, in order
    loop: bool = True
    delay_start: float = 0.0  # s, before every round
    auto_start: bool = True


@dataclass(frozen=True)
class ModelDescription:
    name: str
    pose: Pose = IDENTITY  # in the world
    static: bool = False
    self_collide: bool = False
    links: tuple[LinkDescription, ...] = ()
    joints: tuple[JointDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    child_models: tuple[str, ...] = ()  # names of nested models; their links are named nested::link
    child_poses: dict[str, Pose] = field(default_factory=dict)  # of nested models in this one
    lumped: dict[str, tuple[str, Pose]] = field(default_factory=dict)
    # link that fixed-joint lumping took away -> (surviving link, pose in that link's frame)
    trajectory: Trajectory | None = None  # of an actor


# --- worlds

@dataclass(frozen=True)
class LightDescription:
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


@dataclass(frozen=True)
class Fog:
    """Mixes in a colour with the depth z (m): all of it from `end` on, or 1 - e^-z, 1 - e^-z^2."""

    type: str = "none"  # none, linear, exp, exp2
    colour: Rgba = (1.0, 1.0, 1.0, 1.0)
    start: float = 1.0  # m, of linear
    end: float = 100.0  # m, of linear
    density: float = 1.0  # 1/m, of exp and exp2


@dataclass(frozen=True)
class SceneDescription:
    ambient: Rgba = (0.4, 0.4, 0.4, 1.0)
    background: Rgba = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    sky: bool = False
    fog: Fog = Fog()


@dataclass(frozen=True)
class SphericalDescription:
    """`<spherical_coordinates>`: where on Earth the world's origin is."""

    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    elevation: float = 0.0  # m above the WGS84 ellipsoid
    heading_deg: float = 0.0  # from east to the world's x axis, counter-clockwise


@dataclass(frozen=True)
class WorldDescription:
    name: str = "default"
    gravity: Vector3 = (0.0, 0.0, -9.8)
    magnetic_field: Vector3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    physics: PhysicsDescription = PhysicsDescription()
    scene: SceneDescription = SceneDescription()
    spherical: SphericalDescription | None = None
    models: tuple[ModelDescription, ...] = ()
    lights: tuple[LightDescription, ...] = ()
    plugins: tuple[PluginDescription, ...] = ()
    scenery: tuple[tuple[str, Visual], ...] = ()  # seen but not touched, such as roads
    sim_time: float = 0.0  # s, at which a saved world goes on
