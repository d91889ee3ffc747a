"""Reads SDF sensors, cameras, rays and `<plugin>` elements."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from bullet_sim.description import (
    CameraDescription,
    Noise,
    PluginDescription,
    RayDescription,
    SensorDescription,
)
from bullet_sim.formats.xml_values import child_text, flag, integer, number, pose

DISTORTION = ("k1", "k2", "p1", "p2", "k3")  # the order of OpenCV and of camera_info


def read_plugins(element: Element) -> tuple[PluginDescription, ...]:
    """The plugins directly below an element, as written."""
    return tuple(
        PluginDescription(plugin.get("name", ""), plugin.get("filename", ""), plugin)
        for plugin in element.findall("plugin")
    )


def read_sensor(element: Element, link: str) -> SensorDescription:
    """A sensor of a link, with the cameras or rays it has."""
    name = element.get("name", "")
    where = f"{link}, sensor {name!r}"
    rays = element.find("ray") if element.find("ray") is not None else element.find("lidar")
    return SensorDescription(
        name=name,
        type=element.get("type", ""),
        pose=pose(element, where),
        update_rate=number(element, "update_rate", 0.0, where),
        always_on=flag(element, "always_on", False),
        cameras=tuple(_camera(camera, where) for camera in element.findall("camera")),
        ray=None if rays is None else _ray(rays, f"{where} <{rays.tag}>"),
        plugins=read_plugins(element),
        element=element,
    )


def _camera(element: Element, sensor: str) -> CameraDescription:
    where = f"{sensor} <camera>"
    usual = CameraDescription()
    return CameraDescription(
        horizontal_fov=number(element, "horizontal_fov", usual.horizontal_fov, where),
        width=integer(element, "image/width", usual.width, where),
        height=integer(element, "image/height", usual.height, where),
        format=child_text(element, "image/format", usual.format),
        near=number(element, "clip/near", usual.near, where),
        far=number(element, "clip/far", usual.far, where),
        noise=_noise(element.find("noise"), where),
        distortion=tuple(number(element, f"distortion/{key}", 0.0, where) for key in DISTORTION),
    )


def _ray(element: Element, where: str) -> RayDescription:
    usual = RayDescription()
    across, up = "scan/horizontal/", "scan/vertical/"
    return RayDescription(
        samples=integer(element, across + "samples", usual.samples, where),
        resolution=number(element, across + "resolution", usual.resolution, where),
        min_angle=number(element, across + "min_angle", usual.min_angle, where),
        max_angle=number(element, across + "max_angle", usual.max_angle, where),
        vertical_samples=integer(element, up + "samples", usual.vertical_samples, where),
        vertical_min_angle=number(element, up + "min_angle", usual.vertical_min_angle, where),
        vertical_max_angle=number(element, up + "max_angle", usual.vertical_max_angle, where),
        range_min=number(element, "range/min", usual.range_min, where),
        range_max=number(element, "range/max", usual.range_max, where),
        range_resolution=number(element, "range/resolution", usual.range_resolution, where),
        noise=_noise(element.find("noise"), where),
    )


def _noise(element: Element | None, where: str) -> Noise:
    if element is None:
        return Noise()
    return Noise(
        type=child_text(element, "type", element.get("type", "gaussian")),
        mean=number(element, "mean", 0.0, f"{where} <noise>"),
        stddev=number(element, "stddev", 0.0, f"{where} <noise>"),
    )
