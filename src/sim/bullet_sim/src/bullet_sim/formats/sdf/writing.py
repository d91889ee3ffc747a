"""Writes a model as SDF 1.7, as `gz sdf -p` prints a URDF file after its conversion."""

from collections.abc import Sequence
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from bullet_sim.description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    JointAxis,
    JointDescription,
    LinkDescription,
    Material,
    Mesh,
    ModelDescription,
    Plane,
    Sphere,
    Surface,
    Visual,
)
from bullet_sim.errors import FormatError
from bullet_sim.pose import IDENTITY, Pose

VERSION = "1.7"
TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
UNLIMITED = JointAxis()


def sdf_text(model: ModelDescription) -> str:
    """The model in an `<sdf>` root, indented: what a URDF file can say.

    FormatError names a shape that only SDF files have: they need no conversion.
    """
    root = Element("sdf", version=VERSION)
    target = SubElement(root, "model", name=model.name)
    _pose(target, model.pose)
    if model.static:
        _add(target, "static", "true")
    for link in model.links:
        _link(target, link)
    for joint in model.joints:
        _joint(target, joint)
    target.extend(plugin.element for plugin in model.plugins)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode")


def _link(target: Element, link: LinkDescription) -> None:
    made = SubElement(target, "link", name=link.name)
    _pose(made, link.pose)
    _inertial(made, link.inertial)
    for part in link.collisions:
        _surface(_part(made, "collision", part), part.surface)
    for part in link.visuals:
        _material(_part(made, "visual", part), part.material)
    made.extend(sensor.element for sensor in link.sensors if sensor.element is not None)
    if not link.gravity:
        _add(made, "gravity", "false")
    if link.self_collide:
        _add(made, "self_collide", "true")


def _inertial(link: Element, inertial: Inertial) -> None:
    made = SubElement(link, "inertial")
    _pose(made, inertial.pose)
    _add(made, "mass", inertial.mass)
    tensor = SubElement(made, "inertia")
    for name, value in zip(TENSOR, inertial.inertia):
        _add(tensor, name, value)


def _part(link: Element, kind: str, part: Collision | Visual) -> Element:
    made = SubElement(link, kind, name=part.name)
    _pose(made, part.pose)
    _geometry(SubElement(made, "geometry"), part.geometry)
    return made


def _geometry(target: Element, shape: Geometry) -> None:
    made = SubElement(target, type(shape).__name__.lower())
    match shape:
        case Box():
            _add(made, "size", shape.size)
        case Cylinder():
            _add(made, "radius", shape.radius)
            _add(made, "length", shape.length)
        case Sphere():
            _add(made, "radius", shape.radius)
        case Plane():
            _add(made, "normal", shape.normal)
            _add(made, "size", shape.size)
        case Mesh():
            _add(made, "uri", f"file://{shape.path}")
            _add(made, "scale", shape.scale)
        case _:
            raise FormatError(f"<{made.tag}> cannot be written")


def _surface(collision: Element, surface: Surface) -> None:
    if surface == Surface():
        return
    made = SubElement(collision, "surface")
    ode = SubElement(SubElement(made, "friction"), "ode")
    _add(ode, "mu", surface.mu)
    _add(ode, "mu2", surface.mu2)
    _add(ode, "fdir1", surface.fdir1)
    ode = SubElement(SubElement(made, "contact"), "ode")
    for name in ("kp", "kd", "max_vel", "min_depth"):
        _add(ode, name, getattr(surface, name))


def _material(visual: Element, material: Material | None) -> None:
    if material is not None:
        made = SubElement(visual, "material")
        for name in ("ambient", "diffuse", "specular", "emissive"):
            _add(made, name, getattr(material, name))


def _joint(target: Element, joint: JointDescription) -> None:
    # SDF has no continuous joints: it has revolute ones without limits
    kind = "revolute" if joint.type == "continuous" else joint.type
    made = SubElement(target, "joint", name=joint.name, type=kind)
    _add(made, "parent", joint.parent)
    _add(made, "child", joint.child)
    _pose(made, joint.pose)
    if kind not in ("fixed", "ball"):
        _axis(SubElement(made, "axis"), joint)


def _axis(made: Element, axis: JointAxis) -> None:
    _add(made, "xyz", axis.axis)
    limit = SubElement(made, "limit")
    for name in ("lower", "upper", "effort", "velocity"):
        if getattr(axis, name) != getattr(UNLIMITED, name):
            _add(limit, name, getattr(axis, name))
    dynamics = SubElement(made, "dynamics")
    for name in ("damping", "friction", "spring_reference", "spring_stiffness"):
        _add(dynamics, name, getattr(axis, name))


def _pose(target: Element, pose: Pose) -> None:
    if pose != IDENTITY:
        _add(target, "pose", (*pose.position, *pose.rpy()))


def _add(target: Element, tag: str, value: str | float | Sequence[float]) -> None:
    if not isinstance(value, str):
        values = value if isinstance(value, Sequence) else (value,)
        value = " ".join(f"{number:.9g}" for number in values)
    SubElement(target, tag).text = value
