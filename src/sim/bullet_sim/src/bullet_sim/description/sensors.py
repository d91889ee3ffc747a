"""Sensors on links: what they measure, their rates and their noise; angles in rad, lengths in m."""

from dataclasses import dataclass
from xml.etree.ElementTree import Element

from bullet_sim.pose import IDENTITY, Pose


@dataclass(frozen=True)
class PluginDescription:
    """A `<plugin>` element as written; its loader reads the parameters."""

    name: str
    filename: str
    element: Element


WIDE_ANGLE = "wideanglecamera"  # projects through its `<lens>`
CAMERA_TYPES = ("camera", WIDE_ANGLE, "multicamera", "depth", "depth_camera", "rgbd_camera")
RAY_TYPES = ("ray", "lidar", "gpu_ray", "gpu_lidar")
SENSOR_TYPES = (*CAMERA_TYPES, *RAY_TYPES, "imu", "contact", "force_torque")  # simulated


@dataclass(frozen=True)
class Noise:
    """Errors of a reading, in the reading's unit."""

    type: str = "none"  # none, gaussian or gaussian_quantized
    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0  # of an error drawn once, with a random sign
    bias_stddev: float = 0.0
    precision: float = 0.0  # gaussian_quantized: readings are multiples of it


@dataclass(frozen=True)
class Lens:
    """A wide-angle lens, `<lens>`: r = c1 f fun(theta / c2 + c3), r = 1 half an image wide."""

    c1: float = 2.0  # these four are SDF's stereographic lens, the default without <type>
    c2: float = 2.0
    c3: float = 0.0  # rad
    function: str = "tan"  # sin, tan or id
    f: float = 1.0
    scale_to_hfov: bool = True  # f is chosen so that the image is <horizontal_fov> wide
    cutoff_angle: float = 1.5707  # rad from the axis
    env_texture_size: int = 256  # px, side of each of the images it is made from


@dataclass(frozen=True)
class CameraDescription:
    """One camera: image size, optics and noise."""

    horizontal_fov: float = 1.047
    width: int = 320  # px
    height: int = 240  # px
    format: str = "R8G8B8"
    near: float = 0.1
    far: float = 100.0
    noise: Noise = Noise()
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)  # k1 k2 p1 p2 k3
    distortion_centre: tuple[float, float] = (0.5, 0.5)  # as fractions of width and height
    lens: Lens = Lens()  # used by wide-angle cameras only
    name: str = ""
    pose: Pose = IDENTITY  # in the sensor's frame


@dataclass(frozen=True)
class RayDescription:
    """A fan of rays, `<ray>`; as in SDF, `resolution` times `samples` are cast."""

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
    type: str  # one of SENSOR_TYPES, or one that is not simulated
    pose: Pose = IDENTITY  # in the link frame
    update_rate: float = 0.0  # Hz; 0: as often as possible
    always_on: bool = False
    cameras: tuple[CameraDescription, ...] = ()
    ray: RayDescription | None = None
    imu: ImuDescription = ImuDescription()
    plugins: tuple[PluginDescription, ...] = ()
    element: Element | None = None
