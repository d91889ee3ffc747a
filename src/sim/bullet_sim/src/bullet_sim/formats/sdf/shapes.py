"""Reads SDF geometry, visuals, collisions and their surfaces."""

from xml.etree.ElementTree import Element

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    ImageExtrusion,
    Mesh,
    Plane,
    Polyline,
    Sphere,
    Surface,
    Visual,
)
from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.mistakes import or_without
from bullet_sim.formats.sdf.generated_shapes import read_heightmap, read_image, read_polylines
from bullet_sim.formats.sdf.material import read_material
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import Source
from bullet_sim.formats.xml_values import (
    amount,
    child_text,
    fields,
    flag,
    integer,
    length,
    not_negative,
    number,
    or_default,
    pose,
    vector,
)

ONES = (1.0, 1.0, 1.0)
SIDES = (1.0, 1.0)  # m, of a plane
UNLIMITED_FRICTION = 1e6
NEVER_BOUNCES, FASTEST_BOUNCE = 1e5, 1e3  # m/s; the first is SDF's default


def read_visual(element: Element, source: Source, link: str) -> Visual | None:
    """A visual; None, with one line given, where its shape cannot be had."""
    name = element.get("name", "")
    where = _part(link, element)
    shape = or_without(read_geometry, element.find("geometry"), source, where)
    if shape is None:
        return None
    material = element.find("material")
    return Visual(
        name=name,
        geometry=shape,
        pose=pose(element, where),
        material=None if material is None else read_material(material, source, where),
        transparency=number(element, "transparency", 0.0, where),
        cast_shadows=flag(element, "cast_shadows", True),
        plugins=read_plugins(element),
    )


def read_collision(element: Element, source: Source, link: str) -> Collision | None:
    """A collision; None, with one line given, where its shape cannot be had."""
    name = element.get("name", "")
    where = _part(link, element)
    shape = or_without(read_geometry, element.find("geometry"), source, where)
    if shape is None:
        return None
    if _is_flat(shape):
        source.warn_once(f"{where}: a length of 0 leaves the {type(shape).__name__.lower()} no "
                         "volume to collide with, left out; make it larger than 0")
        return None
    return Collision(
        name=name,
        geometry=shape,
        pose=pose(element, where),
        surface=read_surface(element.find("surface"), where),
        laser_retro=number(element, "laser_retro", 0.0, where),
    )


def _is_flat(shape: Geometry) -> bool:
    match shape:
        case Box(lengths) | Mesh(scale=lengths):
            return 0.0 in lengths
        case Cylinder(radius, length):
            return 0.0 in (radius, length)
        case Sphere(radius):
            return radius == 0.0
        case Polyline(height=height) | ImageExtrusion(height=height):
            return height == 0.0
    return False


def _part(link: str, element: Element) -> str:
    """How errors call a visual or collision; in URDF most have no name."""
    name = element.get("name", "")
    return f"{link}, {element.tag} {name!r}" if name else f"{link}, <{element.tag}>"


def read_surface(element: Element | None, where: str) -> Surface:
    """Contact parameters; only ODE's, Gazebo's default engine."""
    usual = Surface()
    if element is None:
        return usual
    friction = "friction/ode/"
    return Surface(
        mu=_friction(number(element, friction + "mu", usual.mu, where)),
        mu2=_friction(number(element, friction + "mu2", usual.mu2, where)),
        fdir1=vector(element, friction + "fdir1", usual.fdir1, where),
        **fields(number, element, "kp kd min_depth max_vel", usual, where, "contact/ode/"),
        restitution=_restitution(element, where),
        collide_bitmask=integer(
            element, "contact/collide_bitmask", usual.collide_bitmask, where),
        collides=not flag(element, "contact/collide_without_contact", False),
    )


def _restitution(element: Element, where: str) -> float:
    """At most 1; 0 where the speed from which on things bounce is out of reach, as by default."""
    threshold = number(element, "bounce/threshold", NEVER_BOUNCES, where)
    bounce = amount(element, "bounce/restitution_coefficient", 0.0, where)
    return min(bounce, 1.0) if threshold < FASTEST_BOUNCE else 0.0


def read_geometry(element: Element | None, source: Source, where: str) -> Geometry | None:
    """The first shape we know; None for `<empty>`, or with a warning."""
    for shape in () if element is None else element:
        if shape.tag == "polyline":
            return read_polylines(element, source, where)
        reader = READERS.get(shape.tag)
        if reader is not None:
            return reader(shape, source, where)
        if ":" in shape.tag:
            continue
        if shape.tag != "empty":
            source.warn_once(f"{where}: geometry <{shape.tag}> is not supported, left out; "
                             f"there are: {', '.join((*READERS, 'polyline'))}")
        return None
    source.warn_once(f"{where}: no shape in <geometry>, left out")
    return None


def _box(element: Element, source: Source, where: str) -> Box:
    where = f"{where} <box>"
    return Box(not_negative(vector(element, "size", ONES, where), f"{where} <size>"))


def _cylinder(element: Element, source: Source, where: str) -> Cylinder:
    where = f"{where} <cylinder>"
    return Cylinder(length(element, "radius", 1.0, where), length(element, "length", 1.0, where))


def _sphere(element: Element, source: Source, where: str) -> Sphere:
    return Sphere(length(element, "radius", 1.0, f"{where} <sphere>"))


def _plane(element: Element, source: Source, where: str) -> Plane:
    where = f"{where} <plane>"
    size = vector(element, "size", SIDES, where)
    return Plane(
        vector(element, "normal", (0.0, 0.0, 1.0), where),
        or_default(lambda: not_negative(size, f"{where} <size>"), SIDES),
    )


def _mesh(element: Element, source: Source, where: str) -> Mesh | None:
    uri = child_text(element, "uri") or child_text(element, "filename")
    try:
        path = source.resources.resolve(uri, source.folder)
        if not path.is_file():
            raise ResourceNotFound(f"file {uri!r}", [str(path)])
    except ResourceNotFound as error:
        source.warn_once(f"{where}: mesh {error}; left out, the rest is loaded", about=uri)
        return None
    return Mesh(
        path=str(path),
        scale=vector(element, "scale", ONES, f"{where} <mesh>"),
        submesh=child_text(element, "submesh/name") or None,
        centre_submesh=flag(element, "submesh/center", False),
    )


READERS = {
    "box": _box, "cylinder": _cylinder, "sphere": _sphere, "plane": _plane, "mesh": _mesh,
    "heightmap": read_heightmap, "image": read_image,
}


def _friction(coefficient: float) -> float:
    """Below zero means without limit, as ODE has it."""
    return coefficient if coefficient >= 0 else UNLIMITED_FRICTION
