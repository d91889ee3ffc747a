"""Writes the URDF that the engine imports: masses, joints and collision shapes, no visuals."""

import logging
from collections.abc import Callable, Iterable
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from bullet_sim import description
from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.meshes.loading import collision_mesh
from bullet_sim.physics.assembly import PhysicsLink
from bullet_sim.physics.tyres import engine_shapes
from bullet_sim.pose import Pose

log = logging.getLogger(__name__)

Triangles = description.Mesh | description.Generated
MeshPath = Callable[[Triangles, bool], str]  # writes a mesh, or its hull, to a file
LONGEST_NAME = 1023  # bytes of the engine's buffer; longer names overwrite other memory
NO_LIMIT = 1e15  # limits at or beyond this mean none
STATIC_FILTER = (2, -3)  # Bullet's group and mask of static bodies: they do not meet each other
HULL_MARGIN = 1e-3  # m, by which the engine's hulls are larger than their corners (measured)


class MeshFiles:
    """Writes collision meshes as OBJ into a folder that exists during the import."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._written = 0

    def __call__(self, mesh: Triangles, hull: bool) -> str:
        """The file's path; with `hull` only the corners of the triangles count, inset by a margin.

        The engine keeps every corner that it reads until the world ends, even of removed bodies;
        of a closed surface each comes six times.
        """
        vertices, faces = collision_mesh(mesh)
        if hull:
            vertices, faces = _inset(vertices), _each_once(faces)
        lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices]
        lines += [f"f {a} {b} {c}" for a, b, c in faces + 1]
        path = self._folder / f"mesh_{self._written}.obj"
        path.write_text("\n".join(lines) + "\n", encoding="ascii")
        self._written += 1
        return str(path)


def _inset(vertices: np.ndarray) -> np.ndarray:
    """Vertices (n, 3) of a hull that, with the engine's margin around it, has this size."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    part = np.divide(np.maximum(half - HULL_MARGIN, 0.0), half,
                     out=np.zeros(3), where=half > 0.0)
    return middle + part * (vertices - middle)


def _each_once(faces: np.ndarray) -> np.ndarray:
    """Faces (m, 3) with each corner of the others once, in order; filled up from the first."""
    _, first = np.unique(faces, return_index=True)
    corners = faces.ravel()[np.sort(first)]
    return np.resize(corners, (-(-len(corners) // 3), 3))


def urdf_text(links: Iterable[PhysicsLink], mesh_path: MeshPath) -> str:
    """A `<robot>` whose links keep their order, the first being the base. SimulationError for a
    name that is too long."""
    parts = ['<robot name="body">']
    for link in links:
        parts.append(f"<link name={_name(link.name)}>{_inertial(link.inertial)}")
        fixed = link.inertial.mass == 0.0
        parts.extend(_collision(collision, fixed, mesh_path) for collision in engine_shapes(link))
        parts.append("</link>")
        if link.parent is not None:
            parts.append(_joint(link))
    parts.append("</robot>")
    return "\n".join(parts)


def _name(name: str) -> str:
    size = len(name.encode())
    if size > LONGEST_NAME:
        raise SimulationError(f"the engine takes names of at most {LONGEST_NAME} bytes, not of "
                              f"{size}: {name}")
    return quoteattr(name)


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _origin(pose: Pose) -> str:
    return f'<origin xyz="{_numbers(pose.position)}" rpy="{_numbers(pose.rpy())}"/>'


def _inertial(inertial: description.Inertial) -> str:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    tensor = " ".join(f'{n}="{v!r}"' for n, v in zip(names, inertial.inertia, strict=True))
    return (f'<inertial>{_origin(inertial.pose)}<mass value="{inertial.mass!r}"/>'
            f"<inertia {tensor}/></inertial>")


def _collision(collision: description.Collision, fixed: bool, mesh_path: MeshPath) -> str:
    # Static bodies have triangles; others a convex hull (the engine has nothing else).
    concave = ' concave="yes"' if fixed and isinstance(collision.geometry, Triangles) else ""
    try:
        geometry = _geometry(collision.geometry, mesh_path, hull=not fixed)
    except FormatError as error:  # in a mesh file; the rest of the model still spawns
        log.warning("collision %s is left out: %s", collision.name, error)
        return ""
    # The engine knows only a static body's base as such: its other links would touch the next body.
    group, mask = STATIC_FILTER
    static = f' group="{group}" mask="{mask}"' if fixed else ""
    return (f"<collision{concave}{static}>{_origin(collision.pose)}"
            f"<geometry>{geometry}</geometry></collision>")


def _geometry(geometry: description.Geometry, mesh_path: MeshPath, hull: bool) -> str:
    match geometry:
        case description.Box(size):
            return f'<box size="{_numbers(size)}"/>'
        case description.Cylinder(radius, length):
            return f'<cylinder radius="{radius!r}" length="{length!r}"/>'
        case description.Sphere(radius):
            return f'<sphere radius="{radius!r}"/>'
        case description.Plane(normal, _):
            return f'<plane normal="{_numbers(normal)}"/>'
        case _ if isinstance(geometry, Triangles):
            return f'<mesh filename={quoteattr(mesh_path(geometry, hull))}/>'
    raise TypeError(f"no engine shape for {geometry!r}")


def _joint(link: PhysicsLink) -> str:
    joint = link.joint
    kind = "fixed" if joint is None else joint.type
    if kind == "revolute" and joint.lower <= -NO_LIMIT and joint.upper >= NO_LIMIT:
        kind = "continuous"
    if kind in ("revolute", "prismatic") and joint.lower == joint.upper == 0.0:
        kind = "fixed"  # limits would only hold it approximately, and hide its load
    if kind == "ball":
        kind = "spherical"
    name = f"{link.name}__weld" if joint is None else joint.name
    text = (f'<joint name={_name(name)} type="{kind}"><parent link={quoteattr(link.parent)}/>'
            f"<child link={quoteattr(link.name)}/>{_origin(link.pose_parent)}")
    if kind != "fixed":
        text += (f'<axis xyz="{_numbers(joint.axis)}"/>'
                 f'<limit lower="{joint.lower!r}" upper="{joint.upper!r}"/>')
    return text + "</joint>"
