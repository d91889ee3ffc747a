"""Reads SDF's noise models, of sensors and of the axes of an IMU."""

from xml.etree.ElementTree import Element

from bullet_sim.description import ImuDescription, Noise
from bullet_sim.formats.xml_values import child_text, fields, number

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
