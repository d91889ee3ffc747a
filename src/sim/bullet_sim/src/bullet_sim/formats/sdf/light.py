"""Reads SDF `<light>` elements."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from bullet_sim.description import LightDescription
from bullet_sim.formats.xml_values import colour, flag, number, pose, vector


def read_light(element: Element, inside: str = "") -> LightDescription:
    """A light of a world or, with `inside` naming it, of a link."""
    name = element.get("name", "")
    where = f"{inside}, light {name!r}" if inside else f"light {name!r}"
    usual = LightDescription(name)
    return LightDescription(
        name=name,
        type=element.get("type", usual.type),
        pose=pose(element, where),
        diffuse=colour(element, "diffuse", usual.diffuse, where),
        specular=colour(element, "specular", usual.specular, where),
        direction=vector(element, "direction", usual.direction, where),
        cast_shadows=flag(element, "cast_shadows", usual.cast_shadows),
        range=number(element, "attenuation/range", usual.range, where),
        constant=number(element, "attenuation/constant", usual.constant, where),
        linear=number(element, "attenuation/linear", usual.linear, where),
        quadratic=number(element, "attenuation/quadratic", usual.quadratic, where),
        inner_angle=number(element, "spot/inner_angle", usual.inner_angle, where),
        outer_angle=number(element, "spot/outer_angle", usual.outer_angle, where),
        falloff=number(element, "spot/falloff", usual.falloff, where),
    )
