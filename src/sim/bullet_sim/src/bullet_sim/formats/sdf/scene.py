"""Reads the `<scene>` of an SDF world: ambient light, background, sky and fog."""

from xml.etree.ElementTree import Element

from bullet_sim.description import Fog, SceneDescription
from bullet_sim.formats.xml_values import child_text, colour, fields, flag, number, one_of

FOGS = {"none": "none", "linear": "linear", "exp": "exp", "exp2": "exp2",
        "constant": "exp", "quadratic": "exp2"}  # the last two are the names in SDF's own text


def read_scene(element: Element | None, world: str) -> SceneDescription:
    """The scene: everything that does not depend on the camera."""
    usual = SceneDescription()
    if element is None:
        return usual
    where = f"{world} <scene>"
    return SceneDescription(
        **fields(colour, element, "ambient background", usual, where),
        shadows=flag(element, "shadows", usual.shadows),
        sky=element.find("sky") is not None,
        fog=_fog(element.find("fog"), f"{where} <fog>"),
    )


def _fog(element: Element | None, where: str) -> Fog:
    usual = Fog()
    if element is None:
        return usual
    kind = child_text(element, "type", usual.type)
    return Fog(
        type=FOGS[one_of(FOGS, "fog", kind, usual.type, f"{where} <type>")],
        colour=colour(element, "color", usual.colour, where),
        **fields(number, element, "start end density", usual, where),
    )
