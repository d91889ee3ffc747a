"""Reads SDF `<light>` elements."""

from xml.etree.ElementTree import Element

from bullet_sim.description import LightDescription
from bullet_sim.formats.xml_values import colour, fields, flag, number, pose, vector


def read_light(element: Element, inside: str = "") -> LightDescription:
    """A light of a world or, if `inside` names one, of a link."""
    name = element.get("name", "")
    where = f"{inside}, light {name!r}" if inside else f"light {name!r}"
    usual = LightDescription(name)
    return LightDescription(
        name=name,
        type=element.get("type", usual.type),
        pose=pose(element, where),
        **fields(colour, element, "diffuse specular", usual, where),
        direction=vector(element, "direction", usual.direction, where),
        cast_shadows=flag(element, "cast_shadows", usual.cast_shadows),
        **fields(number, element, "range constant linear quadratic", usual, where, "attenuation/"),
        **fields(number, element, "inner_angle outer_angle falloff", usual, where, "spot/"),
    )
