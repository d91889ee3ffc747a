"""Reads SDF sensors, cameras, rays and `<plugin>` elements."""

from xml.etree.ElementTree import Element

from bullet_sim.description import (
    CAMERA_TYPES,
    RAY_TYPES,
    PluginDescription,
    RayDescription,
    SensorDescription,
)
from bullet_sim.formats.sdf.camera import read_camera
from bullet_sim.formats.sdf.noise import read_imu, read_noise
from bullet_sim.formats.xml_values import fields, flag, integer, number, pose


def read_plugins(element: Element) -> tuple[PluginDescription, ...]:
    """The plugins directly below an element, as written."""
    return tuple(
        PluginDescription(plugin.get("name", ""), plugin.get("filename", "").strip(), plugin)
        for plugin in element.findall("plugin")
    )


def read_sensor(element: Element, link: str) -> SensorDescription:
    """A sensor of a link, with the cameras or rays it has."""
    name, kind = element.get("name", ""), element.get("type", "")
    where = f"{link}, sensor {name!r}"
    # A missing <camera> or <ray> is made of defaults.
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
