"""The scene: lights, and links with surfaces and poses, as data without a renderer."""

import itertools
import logging
import math
import operator
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from weakref import WeakValueDictionary

import numpy as np

from bullet_sim.description import (
    Generated,
    LightDescription,
    Material,
    Mesh,
    Plane,
    SceneDescription,
    Visual,
)
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.meshes.loading import load_mesh
from bullet_sim.meshes.part import MeshPart, box_corners, join_parts
from bullet_sim.pose import Pose
from bullet_sim.rendering.primitives import primitive_part

log = logging.getLogger(__name__)

LinkKey = tuple[str, str]  # model, link

_THINNEST = 0.001  # m, of a box: each of its edges has a direction
# The look of a surface without any material: a whitish grey.
DEFAULT_MATERIAL = Material(ambient=(0.7, 0.7, 0.7, 1.0), diffuse=(0.7, 0.7, 0.7, 1.0))


@dataclass(frozen=True, eq=False)
class LinkShape:
    """The look of links with equal visuals; shared by them, compared by identity."""

    parts: tuple[MeshPart, ...]  # in the link frame, of one material each
    centre: np.ndarray  # (3,) m, of a sphere around all parts, in the link frame
    radius: float  # m
    plane_size: float = 0.0  # m, longest side if all parts are planes; 0 if not


class Node:
    """One link in the scene, at its pose at one moment."""

    __slots__ = ("shape", "pose", "_matrix")

    def __init__(self, shape: LinkShape, pose: Pose):
        self.shape = shape
        self.pose = pose  # link frame in the world
        self._matrix: np.ndarray | None = None

    @property
    def matrix(self) -> np.ndarray:
        """(4, 4) float64 of the pose; computed at first use."""
        if self._matrix is None:
            self._matrix = self.pose.matrix()
        return self._matrix


@dataclass(frozen=True, eq=False)
class Look:
    """All of a scene that a picture depends on. It keeps no meshes in memory."""

    version: int
    poses: tuple[Pose, ...]
    images: tuple[np.ndarray, ...]

    def equals(self, other: "Look") -> bool:
        """Whether one camera sees the same, to the last bit."""
        return (self.version == other.version and self.poses == other.poses
                and len(self.images) == len(other.images)
                and all(map(operator.is_, self.images, other.images)))


@dataclass(eq=False)
class SceneState:
    """Lights and links at one moment: a renderer's input. Equal versions differ only in poses."""

    description: SceneDescription
    lights: dict[str, LightDescription]
    nodes: dict[LinkKey, Node]
    version: int
    # Textures that are not files, by their name in materials: (h, w, 3) uint8 RGB, top row
    # first, never written to. Another array under the same name has the same size.
    images: dict[str, np.ndarray] = field(default_factory=dict)

    def look(self) -> Look:
        """What has to be equal for an equal picture."""
        return Look(self.version, tuple(node.pose for node in self.nodes.values()),
                    tuple(self.images.values()))

    def plane_ranks(self) -> dict[float, int]:
        """Rank by size of the planes that links are made of, the smallest 0.

        Courses are on the ground plane, at one height: where planes meet, the larger is behind.
        """
        sizes = sorted({node.shape.plane_size for node in self.nodes.values()} - {0.0})
        return {size: rank for rank, size in enumerate(sizes)}


_versions = itertools.count()  # over all scenes, so that a version stands for one content


class Scene(SceneState):
    """Lights and links by name, which may be added, moved and removed."""

    def __init__(self, description: SceneDescription = SceneDescription()):
        super().__init__(description, {}, {}, next(_versions))
        self._shapes: WeakValueDictionary[tuple[Visual, ...], LinkShape] = WeakValueDictionary()
        self.visuals: dict[LinkKey, tuple[Visual, ...]] = {}  # of each link

    def frozen(self) -> SceneState:
        """A copy of the current state; another thread may draw it while the scene changes."""
        return SceneState(self.description, dict(self.lights), dict(self.nodes), self.version,
                          dict(self.images))

    def add_light(self, light: LightDescription) -> None:
        """Poses and directions of lights are in the world.

        SimulationError if there is one of that name.
        """
        if light.name in self.lights:
            raise SimulationError(f"a light named {light.name!r} is already there")
        self.lights[light.name] = light
        self.version = next(_versions)

    def remove_light(self, name: str) -> None:
        """Remove a light; UnknownName if there is none of that name."""
        if name not in self.lights:
            raise UnknownName("light", name, self.lights)
        del self.lights[name]
        self.version = next(_versions)

    def change_light(self, light: LightDescription) -> None:
        """Change the properties of the light of that name; UnknownName if there is none."""
        if light.name not in self.lights:
            raise UnknownName("light", light.name, self.lights)
        self.lights[light.name] = light  # in its old position: of too many, the last are left out
        self.version = next(_versions)

    def add_link(self, key: LinkKey, visuals: Sequence[Visual], pose: Pose) -> None:
        """Visuals whose mesh cannot be read are left out, with one warning each.

        SimulationError if the link is there already.
        """
        if key in self.nodes:
            raise SimulationError(f"the scene already has a link {'::'.join(key)}")
        self._put(key, tuple(visuals), pose)

    def _put(self, key: LinkKey, wanted: tuple[Visual, ...], pose: Pose) -> None:
        shape = self._shapes.get(wanted)
        if shape is None:
            shape = self._shapes[wanted] = link_shape(wanted)
        self.nodes[key] = Node(shape, pose)
        self.visuals[key] = wanted
        self.version = next(_versions)

    def add_visual(self, key: LinkKey, visual: Visual) -> None:
        """Add a visual to a link that is there."""
        self._put(key, (*self.visuals[key], visual), self.nodes[key].pose)

    def remove_model(self, model: str) -> None:
        """Remove all links of a model; a model without links in the scene is no error."""
        for key in [key for key in self.nodes if key[0] == model]:
            del self.nodes[key], self.visuals[key]
            self.version = next(_versions)

    def set_pose(self, key: LinkKey, pose: Pose) -> None:
        """Move a link, pose in the world; UnknownName if it is not in the scene.

        It stays in place while its pose is not finite: the engine's may be NaN for a moment.
        """
        node = self.nodes.get(key)
        if node is None:
            raise UnknownName("link", "::".join(key), ("::".join(known) for known in self.nodes))
        if node.pose is pose:
            return  # a link that stands still keeps its node, and the matrix in it
        if math.isfinite(sum((*pose.position, *pose.orientation))):
            self.nodes[key] = Node(node.shape, pose)


def link_shape(visuals: Sequence[Visual]) -> LinkShape:
    """All visuals of a link in the link frame, with parts of equal look joined into one."""
    alike: dict[tuple[Material, bool], list[MeshPart]] = {}
    for visual in visuals:
        for part in _visual_parts(visual):
            alike.setdefault((part.material, part.casts_shadows), []).append(part)
    parts = tuple(join_parts(parts) for parts in alike.values())
    if not parts:
        return LinkShape((), np.zeros(3), 0.0)
    low = np.min([part.vertices.min(axis=0) for part in parts], axis=0)
    high = np.max([part.vertices.max(axis=0) for part in parts], axis=0)
    centre = (low.astype(float) + high) / 2
    reach = [np.linalg.norm(part.vertices - centre, axis=1).max() for part in parts]
    return LinkShape(parts, centre, float(max(reach)), _plane_size(visuals))


def _plane_size(visuals: Sequence[Visual]) -> float:
    if not all(isinstance(visual.geometry, Plane) for visual in visuals):
        return 0.0
    return max(max(visual.geometry.size) for visual in visuals)


def _visual_parts(visual: Visual) -> list[MeshPart]:
    try:
        parts = _surface(visual)
    except SimulationError as error:
        log.warning("visual %s is left out: %s", visual.name, error)
        return []
    placed = [_placed(part, visual) for part in parts]
    return [part for part in placed if part.material.diffuse[3] > 0]


def _surface(visual: Visual) -> tuple[MeshPart, ...]:
    if isinstance(visual.geometry, Mesh | Generated):
        return load_mesh(visual.geometry)
    return (primitive_part(visual.geometry),)


def _placed(part: MeshPart, visual: Visual) -> MeshPart:
    """In the link frame, with its material: the visual's own, else the file's, else the default."""
    material = visual.material or part.material or DEFAULT_MATERIAL
    if visual.transparency > 0:
        red, green, blue, alpha = material.diffuse
        alpha *= max(0.0, 1 - visual.transparency)
        material = replace(material, diffuse=(red, green, blue, alpha))
    matrix = visual.pose.matrix()
    vertices = part.vertices @ matrix[:3, :3].T + matrix[:3, 3]
    normals = part.normals @ matrix[:3, :3].T
    placed = replace(
        part,
        vertices=vertices.astype(np.float32),
        normals=normals.astype(np.float32),
        material=material,
        casts_shadows=visual.cast_shadows,
        boxes=matrix[None] @ box_corners(part, _THINNEST),
    )
    return join_parts([placed, _turned_over(placed)]) if material.double_sided else placed


def _turned_over(part: MeshPart) -> MeshPart:
    """The same triangles, seen from behind."""
    return replace(part, normals=-part.normals, faces=np.ascontiguousarray(part.faces[:, ::-1]),
                   boxes=part.boxes[:0])
