"""Reads `<road>`: a band on the ground that is drawn but never collides."""

from xml.etree.ElementTree import Element

from bullet_sim.description import Material, Strip, Visual
from bullet_sim.errors import FormatError
from bullet_sim.formats.gazebo_materials import named_materials
from bullet_sim.formats.sdf.material import read_material
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import amount, bounded, numbers
from bullet_sim.pose import Pose

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
