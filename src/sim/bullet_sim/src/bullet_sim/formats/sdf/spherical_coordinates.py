"""Reads where on Earth a world is: `<spherical_coordinates>`."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from bullet_sim.description import SphericalDescription
from bullet_sim.formats.xml_values import number


def read_spherical(element: Element | None, world: str) -> SphericalDescription | None:
    """The world's place in degrees and metres; None where the file names none.

    Of surface models there is WGS84 alone, of world frames east-north-up, whatever is written.
    """
    if element is None:
        return None
    where = f"{world} <spherical_coordinates>"
    return SphericalDescription(
        latitude_deg=number(element, "latitude_deg", 0.0, where),
        longitude_deg=number(element, "longitude_deg", 0.0, where),
        elevation=number(element, "elevation", 0.0, where),
        heading_deg=number(element, "heading_deg", 0.0, where),
    )
