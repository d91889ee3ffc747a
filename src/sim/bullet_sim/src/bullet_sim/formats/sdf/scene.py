"""Lights, roads and the scene's colours."""

from xml.etree.ElementTree import Element

from bullet_sim.description import Fog, LightDescription, Material, SceneDescription, Strip, Visual
from bullet_sim.errors import FormatError
from bullet_sim.formats.ogre import named_materials
from bullet_sim.formats.sdf.material import read_material
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import (
    amount,
    bounded,
    child_text,
    colour,
    fields,
    flag,
    number,
    numbers,
    one_of,
    pose,
    vector,
)
from bullet_sim.pose import Pose


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


LIFT = Pose((0.0, 0.0, 0.005))  # m, above the ground it is drawn on


def read_road(element: Element, source: Source) -> Visual:
    """A road as one visual in the world's frame. FormatError for fewer than two points."""
    name = element.get("name", "road")
    where = f"road {name!r}"
    points = tuple(bounded(numbers(point.text or "", 3, f"{where} <point>"), f"{where} <point>")
                   for point in element.findall("point"))
    if len(points) < 2:
        raise FormatError(f"{where}: a road needs two <point>s or more")
    written = element.find("material")
    material: Material | None = None
    if written is not None:
        material = read_material(written, source, where)
    return Visual(name, Strip(points, amount(element, "width", 1.0, where)), LIFT,
                  material or named_materials()["Gazebo/Road"], cast_shadows=False)


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
