"""Reads SDF sensors, cameras, rays and `<plugin>` elements."""

from xml.etree.ElementTree import Element

import bullet_sim.formats.xml_values as xml
from bullet_sim.description import (
    CAMERA_TYPES,
    RAY_TYPES,
    CameraDescription,
    ImuDescription,
    Lens,
    Noise,
    PluginDescription,
    RayDescription,
    SensorDescription,
)
from bullet_sim.formats.xml_values import child_text, fields, flag, integer, number, pose

AXES = ("x", "y", "z")


def read_noise(element: Element | None, where: str, kind: str = "gaussian") -> Noise:
    """A `<noise>` of the type in its attribute (SDF 1.5) or child (1.4), else `kind`."""
    if element is None:
        return Noise()
    return Noise(
        type=child_text(element, "type", element.get("type", kind)),
        **fields(number, element, "mean stddev bias_mean bias_stddev precision", Noise(),
                 f"{where} <noise>"),
    )


def read_imu(element: Element | None, where: str) -> ImuDescription:
    """The `<imu>` of a sensor: noise per axis, or as in SDF 1.4 the same for all three."""
    if element is None:
        return ImuDescription()
    where = f"{where} <imu>"
    old = element.find("noise")
    if old is not None:
        kind = child_text(old, "type", old.get("type", "gaussian"))
        rate, acceleration = (read_noise(old.find(tag), where, kind) for tag in ("rate", "accel"))
        return ImuDescription((rate,) * 3, (acceleration,) * 3)
    return ImuDescription(*(
        tuple(read_noise(element.find(f"{tag}/{axis}/noise"), f"{where} <{tag}> <{axis}>")
              for axis in AXES)
        for tag in ("angular_velocity", "linear_acceleration")))


def read_plugins(element: Element) -> tuple[PluginDescription, ...]:
    """The plugins directly below an element, as written."""
    return tuple(
        PluginDescription(plugin.get("name", ""), plugin.get("filename", "").strip(), plugin)
        for plugin in element.findall("plugin")
    )


def read_sensor(element: Element, link: str) -> SensorDescription:
    """A sensor of a link, with its cameras or rays."""
    name, kind = element.get("name", ""), element.get("type", "")
    where = f"{link}, sensor {name!r}"
    # A missing <camera> or <ray> has the defaults.
    cameras = element.findall("camera") or [Element("camera")] * (kind in CAMERA_TYPES)
    rays = [*element.findall("ray"), *element.findall("lidar")]
    rays = rays or [Element("ray")] * (kind in RAY_TYPES)
    return SensorDescription(
        name=name,
        type=kind,
        pose=pose(element, where),
        update_rate=number(element, "update_rate", 0.0, where),
        always_on=flag(element, "always_on", False),
        cameras=tuple(read_camera(camera, where) for camera in cameras),
        ray=_ray(rays[0], f"{where} <{rays[0].tag}>") if rays else None,
        imu=read_imu(element.find("imu"), where),
        plugins=read_plugins(element),
        element=element,
    )


def _ray(element: Element, where: str) -> RayDescription:
    usual = RayDescription()
    across, up = "scan/horizontal/", "scan/vertical/"
    return RayDescription(
        samples=integer(element, across + "samples", usual.samples, where),
        **fields(number, element, "resolution min_angle max_angle", usual, where, across),
        vertical_samples=integer(element, up + "samples", usual.vertical_samples, where),
        **fields(number, element, "resolution min_angle max_angle", usual, where, up, "vertical_"),
        **fields(number, element, "min max resolution", usual, where, "range/", "range_"),
        noise=read_noise(element.find("noise"), where),
    )


DISTORTION = ("k1", "k2", "p1", "p2", "k3")  # the order of OpenCV and of camera_info
LENSES = {  # type: c1, c2, function of r = c1 f fun(theta / c2)
    "gnomonical": (1.0, 1.0, "tan"),
    "stereographic": (2.0, 2.0, "tan"),
    "equidistant": (1.0, 1.0, "id"),
    "equisolid_angle": (2.0, 2.0, "sin"),
    "orthographic": (1.0, 1.0, "sin"),
}
USUAL_LENS = "stereographic"
FUNCTIONS = ("sin", "tan", "id")


def read_camera(element: Element, sensor: str) -> CameraDescription:
    """One camera; `sensor` names its sensor in errors."""
    name = element.get("name", "")
    where = f"{sensor} <camera name={name!r}>" if name else f"{sensor} <camera>"
    usual = CameraDescription()
    return CameraDescription(
        name=name,
        pose=xml.pose(element, where),
        horizontal_fov=xml.number(element, "horizontal_fov", usual.horizontal_fov, where),
        **xml.fields(xml.integer, element, "width height", usual, where, "image/"),
        format=xml.child_text(element, "image/format", usual.format),
        **xml.fields(xml.number, element, "near far", usual, where, "clip/"),
        noise=read_noise(element.find("noise"), where),
        distortion=tuple(
            xml.number(element, f"distortion/{key}", 0.0, where) for key in DISTORTION),
        distortion_centre=xml.vector(element, "distortion/center", usual.distortion_centre, where),
        lens=_lens(element.find("lens"), f"{where} <lens>"),
    )


def _lens(element: Element | None, where: str) -> Lens:
    if element is None:
        return Lens()
    usual = Lens()
    kind = xml.one_of((*LENSES, "custom"), "lens", xml.child_text(element, "type", USUAL_LENS),
                      USUAL_LENS, f"{where} <type>")
    own = "custom_function/"
    if kind == "custom":
        function = xml.one_of(FUNCTIONS, "function", xml.child_text(
            element, own + "fun", usual.function), usual.function, f"{where} <fun>")
        c1 = xml.number(element, own + "c1", 1.0, where)
        c2 = xml.number(element, own + "c2", 1.0, where)
    else:
        c1, c2, function = LENSES[kind]
    return Lens(
        c1=c1,
        c2=c2,
        function=function,
        **(xml.fields(xml.number, element, "c3 f", usual, where, own) if kind == "custom" else {}),
        scale_to_hfov=xml.flag(element, "scale_to_hfov", usual.scale_to_hfov),
        cutoff_angle=xml.number(element, "cutoff_angle", usual.cutoff_angle, where),
        env_texture_size=xml.integer(element, "env_texture_size", usual.env_texture_size, where),
    )
