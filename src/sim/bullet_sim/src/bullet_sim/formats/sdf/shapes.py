"""Reads SDF geometry, visuals, collisions and their surfaces."""

from dataclasses import replace
from xml.etree.ElementTree import Element

import bullet_sim.formats.xml_values as xml
from bullet_sim import description
from bullet_sim.errors import ResourceNotFound
from bullet_sim.formats.mistakes import or_without
from bullet_sim.formats.sdf.generated_shapes import read_heightmap, read_image, read_polylines
from bullet_sim.formats.sdf.material import read_material
from bullet_sim.formats.sdf.sensor import read_plugins
from bullet_sim.formats.source import Source
from bullet_sim.pose import Vector3


def scaled_model(model: description.ModelDescription,
                 factors: Vector3) -> description.ModelDescription:
    """Shapes grow about their own centres; no pose or mass changes (Gazebo's Link::SetScale)."""
    return replace(model, links=tuple(
        replace(
            link,
            visuals=_scaled_parts(link.visuals, factors),
            collisions=_scaled_parts(link.collisions, factors),
        )
        for link in model.links
    ))


def _scaled_parts(parts: tuple, factors: Vector3) -> tuple:
    return tuple(replace(part, geometry=scaled(part.geometry, factors)) for part in parts)


def scaled(shape: description.Geometry, factors: Vector3) -> description.Geometry:
    """A shape scaled along its own axes; round ones stay round, by their largest factor."""
    x, y, z = factors
    match shape:
        case description.Box(size):
            return description.Box(_product(size, factors))
        case description.Cylinder(radius, length):
            return description.Cylinder(radius * max(x, y), length * z)
        case description.Sphere(radius):
            return description.Sphere(radius * max(factors))
        case description.Mesh(scale=scale):
            return replace(shape, scale=_product(scale, factors))
        case description.Heightmap(size=size):
            return replace(shape, size=_product(size, factors))
        case description.Polyline(outlines, height):
            return description.Polyline(
                tuple(tuple((px * x, py * y) for px, py in outline) for outline in outlines),
                height * z)
    return shape


def _product(lengths: Vector3, factors: Vector3) -> Vector3:
    return tuple(length * factor for length, factor in zip(lengths, factors, strict=True))


ONES = (1.0, 1.0, 1.0)
SIDES = (1.0, 1.0)  # m, of a plane
UNLIMITED_FRICTION = 1e6
NEVER_BOUNCES, FASTEST_BOUNCE = 1e5, 1e3  # m/s; the first is SDF's default


def read_visual(element: Element, source: Source, link: str) -> description.Visual | None:
    """A visual; None, with a line logged, if its shape cannot be used."""
    where, shape = _shape(element, source, link)
    if shape is None:
        return None
    material = element.find("material")
    return description.Visual(
        name=element.get("name", ""),
        geometry=shape,
        pose=xml.pose(element, where),
        material=None if material is None else read_material(material, source, where),
        transparency=xml.number(element, "transparency", 0.0, where),
        cast_shadows=xml.flag(element, "cast_shadows", True),
        plugins=read_plugins(element),
    )


def read_collision(element: Element, source: Source, link: str) -> description.Collision | None:
    """A collision; None, with a line logged, if its shape cannot be used."""
    where, shape = _shape(element, source, link)
    if shape is None:
        return None
    if _is_flat(shape):
        source.warn_once(f"{where}: a length of 0 leaves the {type(shape).__name__.lower()} no "
                         "volume to collide with, left out; make it larger than 0")
        return None
    return description.Collision(
        name=element.get("name", ""),
        geometry=shape,
        pose=xml.pose(element, where),
        surface=read_surface(element.find("surface"), where),
        laser_retro=xml.number(element, "laser_retro", 0.0, where),
    )


def _is_flat(shape: description.Geometry) -> bool:
    match shape:
        case description.Box(lengths) | description.Mesh(scale=lengths):
            return 0.0 in lengths
        case description.Cylinder(radius, length):
            return 0.0 in (radius, length)
        case description.Sphere(radius):
            return radius == 0.0
        case description.Polyline(height=height) | description.ImageExtrusion(height=height):
            return height == 0.0
    return False


def _shape(element: Element, source: Source, link: str
           ) -> tuple[str, description.Geometry | None]:
    """The text for a visual or collision in errors, as most in URDF have no name; and its shape."""
    name = element.get("name", "")
    where = f"{link}, {element.tag} {name!r}" if name else f"{link}, <{element.tag}>"
    return where, or_without(read_geometry, element.find("geometry"), source, where)


def read_surface(element: Element | None, where: str) -> description.Surface:
    """Contact parameters; only ODE's, Gazebo's default engine."""
    usual = description.Surface()
    if element is None:
        return usual
    friction = "friction/ode/"
    return description.Surface(
        mu=_friction(xml.number(element, friction + "mu", usual.mu, where)),
        mu2=_friction(xml.number(element, friction + "mu2", usual.mu2, where)),
        fdir1=xml.vector(element, friction + "fdir1", usual.fdir1, where),
        **xml.fields(xml.number, element, "kp kd min_depth max_vel", usual, where, "contact/ode/"),
        restitution=_restitution(element, where),
        collide_bitmask=xml.integer(
            element, "contact/collide_bitmask", usual.collide_bitmask, where),
        collides=not xml.flag(element, "contact/collide_without_contact", False),
    )


def _restitution(element: Element, where: str) -> float:
    """At most 1; 0 if the speed at which things begin to bounce is out of reach, as by default."""
    threshold = xml.number(element, "bounce/threshold", NEVER_BOUNCES, where)
    bounce = xml.amount(element, "bounce/restitution_coefficient", 0.0, where)
    return min(bounce, 1.0) if threshold < FASTEST_BOUNCE else 0.0


def read_geometry(element: Element | None, source: Source,
                  where: str) -> description.Geometry | None:
    """The first known shape; None for `<empty>`, or with a warning.

    FormatError for impossible numbers.
    """
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


def _box(element: Element, source: Source, where: str) -> description.Box:
    where = f"{where} <box>"
    size = xml.vector(element, "size", ONES, where)
    return description.Box(xml.not_negative(size, f"{where} <size>"))


def _cylinder(element: Element, source: Source, where: str) -> description.Cylinder:
    where = f"{where} <cylinder>"
    return description.Cylinder(xml.length(element, "radius", 1.0, where),
                                xml.length(element, "length", 1.0, where))


def _sphere(element: Element, source: Source, where: str) -> description.Sphere:
    return description.Sphere(xml.length(element, "radius", 1.0, f"{where} <sphere>"))


def _plane(element: Element, source: Source, where: str) -> description.Plane:
    where = f"{where} <plane>"
    size = xml.vector(element, "size", SIDES, where)
    return description.Plane(
        xml.vector(element, "normal", (0.0, 0.0, 1.0), where),
        xml.or_default(lambda: xml.not_negative(size, f"{where} <size>"), SIDES),
    )


def _mesh(element: Element, source: Source, where: str) -> description.Mesh | None:
    uri = xml.child_text(element, "uri") or xml.child_text(element, "filename")
    try:
        path = source.resources.resolve(uri, source.folder)
        if not path.is_file():
            raise ResourceNotFound(f"file {uri!r}", [str(path)])
    except ResourceNotFound as error:
        source.warn_once(f"{where}: mesh {error}; left out, the rest is loaded", about=uri)
        return None
    return description.Mesh(
        path=str(path),
        scale=xml.vector(element, "scale", ONES, f"{where} <mesh>"),
        submesh=xml.child_text(element, "submesh/name") or None,
        centre_submesh=xml.flag(element, "submesh/center", False),
    )


READERS = {
    "box": _box, "cylinder": _cylinder, "sphere": _sphere, "plane": _plane, "mesh": _mesh,
    "heightmap": read_heightmap, "image": read_image,
}


def _friction(coefficient: float) -> float:
    """A negative value means no limit (Gazebo's FrictionPyramid::SetMu)."""
    return coefficient if coefficient >= 0 else UNLIMITED_FRICTION
