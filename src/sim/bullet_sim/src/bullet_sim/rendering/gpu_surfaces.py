"""Triangles and materials on the graphics card, uploaded once for all links that look the same.

Where half a pixel makes no difference, a mesh is drawn with fewer triangles (`meshes/detail`).
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from weakref import WeakKeyDictionary, WeakValueDictionary

import cv2
import moderngl
import numpy as np

from bullet_sim.description import Fog, Material
from bullet_sim.meshes.detail import FEWEST, finest_tolerance, levels
from bullet_sim.meshes.images import load_image
from bullet_sim.meshes.part import MeshPart
from bullet_sim.rendering.scene import LinkShape
from bullet_sim.rendering.shaders import EXP, EXP2, LINEAR, sources

LIGHTS_BINDING, SURFACE_BINDING, SHADOWS_BINDING = 0, 1, 2
IMAGE_UNIT, SHADOWS_UNIT = 0, 1
_FEW = 500
_IN_FRONT = 1e-4  # m
_FOGS = {"linear": LINEAR, "exp": EXP, "exp2": EXP2}


@dataclass(frozen=True)
class Kind:
    """A kind of drawing a surface."""

    per_pixel: bool  # else lit per corner
    lights: tuple[tuple[int, int], ...]  # kind, and number of its shadow, -1: none
    highlight: bool  # whether one may be visible on it
    fog: Fog | None = None
    shadows: int = 0  # how many lights cast them


@dataclass(eq=False)
class Program:
    """One kind of surface shader."""

    program: moderngl.Program
    projection_model: moderngl.Uniform
    model: moderngl.Uniform


Drawing = tuple[Program, moderngl.VertexArray]


@dataclass(eq=False)
class Triangles:
    """The triangles of all parts with equal ones."""

    vertices: moderngl.Buffer
    indices: moderngl.Buffer
    textured: bool  # else the material's colour alone
    convex: bool  # few, as of planes and boxes, none of them in front of another
    finest: float  # m, tolerance of the first of the coarser ones, inf: there are none
    part: MeshPart | None  # to make those from, when one is needed first
    coarser: list[tuple[float, Triangles]]  # by tolerance, m, the finest first
    drawings: dict[Kind, Drawing]


@dataclass(eq=False)
class Surface:
    """One part of a link, ready to draw."""

    triangles: Triangles
    material: moderngl.Buffer
    texture: moderngl.Texture | None
    opaque: bool
    highlight: float  # brightest specular channel, 0..1
    casts_shadows: bool


class SurfaceStore:
    """Uploaded link shapes, kept as long as a scene has the shape."""

    def __init__(self, context: moderngl.Context, anisotropy: float = 1.0):
        self._context = context
        self._anisotropy = anisotropy  # of textures seen at a flat angle
        self._surfaces: WeakKeyDictionary[LinkShape, list[Surface]] = WeakKeyDictionary()
        self._triangles: WeakValueDictionary[bytes, Triangles] = WeakValueDictionary()
        self._textures: WeakValueDictionary[str, moderngl.Texture] = WeakValueDictionary()
        self._unreadable: set[str] = set()  # images with a warning logged
        self._programs: dict[tuple[Kind, bool], Program] = {}
        self._images: Mapping[str, np.ndarray] = {}
        self._shown: dict[str, np.ndarray] = {}  # of the images, the ones on the card

    def show(self, images: Mapping[str, np.ndarray]) -> None:
        """Set the images of textures that are not files; see `SceneState.images`."""
        self._images = images
        for name, image in images.items():
            texture = self._textures.get(name)
            if texture is not None and self._shown.get(name) is not image:
                texture.write(_rgba(image))
                texture.build_mipmaps()
                self._shown[name] = image
        for name in self._shown.keys() - images.keys():
            del self._shown[name]

    def of(self, shape: LinkShape) -> list[Surface]:
        """The shape's surfaces, uploaded at first use."""
        surfaces = self._surfaces.get(shape)
        if surfaces is None:
            surfaces = self._surfaces[shape] = [self._upload(part) for part in shape.parts]
        return surfaces

    def coarser(self, triangles: Triangles) -> list[tuple[float, Triangles]]:
        """Coarser triangles by tolerance, m, the finest first; made at first use."""
        if triangles.part is not None:
            triangles.coarser = [
                (level.tolerance, self._triangles_of(level.part, triangles.textured, False))
                for level in levels(triangles.part)]
            triangles.part = None
        return triangles.coarser

    def keep(self, kinds: set[Kind]) -> None:
        """Drop the drawings of other kinds."""
        for known in [key for key in self._programs if key[0] not in kinds]:
            del self._programs[known]
        for triangles in self._triangles.values():
            for kind in triangles.drawings.keys() - kinds:
                del triangles.drawings[kind]

    def drawing(self, triangles: Triangles, kind: Kind) -> Drawing:
        """The program and vertex array for these triangles."""
        found = triangles.drawings.get(kind)
        if found is None:
            program = self._program(kind, triangles.textured)
            layout = "3f 3f 2f" if triangles.textured else "3f 3f 2x4"
            names = ["in_position", "in_normal", "in_uv"][:3 if triangles.textured else 2]
            array = self._context.vertex_array(
                program.program, [(triangles.vertices, layout, *names)], triangles.indices
            )
            found = triangles.drawings[kind] = (program, array)
        return found

    def _program(self, kind: Kind, textured: bool) -> Program:
        if (kind, textured) not in self._programs:
            fog = kind.fog
            program = self._context.program(
                **sources(kind.per_pixel, textured, kind.lights, kind.highlight, fog is not None,
                          kind.shadows))
            if kind.shadows:
                program["shadow_maps"] = SHADOWS_UNIT
                program["Shadows"].binding = SHADOWS_BINDING
            if fog is not None:
                program["fog_colour"] = fog.colour[:3]
                program["fog_kind"] = _FOGS[fog.type]
                program["fog_shape"] = fog.start, fog.end, fog.density
            program["Lights"].binding = LIGHTS_BINDING
            program["Surface"].binding = SURFACE_BINDING
            self._programs[kind, textured] = Program(
                program, program["projection_model"], program["model"])
        return self._programs[kind, textured]

    def _upload(self, part: MeshPart) -> Surface:
        material = part.material
        texture = None
        if material.texture is not None and part.uv is not None:
            texture = self._texture(material.texture)
        return Surface(
            triangles=self._triangles_of(part, texture is not None, texture is None),
            material=self._context.buffer(_material_block(material)),
            texture=texture,
            opaque=material.diffuse[3] >= 1,
            highlight=max(material.specular[:3]) if material.shininess > 0 else 0.0,
            casts_shadows=part.casts_shadows and material.diffuse[3] >= 1,
        )

    def _triangles_of(self, part: MeshPart, textured: bool, levelled: bool) -> Triangles:
        """Triangles of a part, uploaded once. `levelled`: with coarser ones."""
        uv = part.uv if textured else np.zeros((len(part.vertices), 2), np.float32)
        corners = np.concatenate([part.vertices, part.normals, uv], axis=1, dtype=np.float32)
        faces = np.ascontiguousarray(part.faces)
        content = corners.tobytes() + faces.tobytes() + bytes([textured, levelled])
        key = hashlib.blake2b(content).digest()
        found = self._triangles.get(key)
        if found is None:
            levelled = levelled and len(faces) >= FEWEST
            found = self._triangles[key] = Triangles(
                self._context.buffer(corners), self._context.buffer(faces), textured,
                len(part.faces) <= _FEW and _is_convex(part),
                finest_tolerance(part) if levelled else math.inf, part if levelled else None,
                [], {})
        return found

    def _texture(self, path: str) -> moderngl.Texture | None:
        """With mipmaps, so that thin lines far away fade instead of breaking up."""
        texture = self._textures.get(path)
        if texture is not None or path in self._unreadable:
            return texture
        if path in self._images:
            self._shown[path] = self._images[path]
            image = _rgba(self._images[path])
        else:
            image = load_image(path, self._context.info["GL_MAX_TEXTURE_SIZE"])
        if image is None:
            self._unreadable.add(path)
            return None
        height, width = image.shape[:2]
        texture = self._textures[path] = self._context.texture((width, height), 4, image)
        texture.build_mipmaps()
        texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        if self._anisotropy > 1:
            texture.anisotropy = self._anisotropy
        texture.repeat_x = texture.repeat_y = path not in self._images
        return texture


def _is_convex(part: MeshPart) -> bool:
    first, second, third = part.vertices[part.faces.T].astype(float)
    across = np.cross(second - first, third - first)
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    return bool(np.all(part.vertices @ across.T < np.sum(first * across, axis=1) + _IN_FRONT))


def _rgba(rgb: np.ndarray) -> np.ndarray:
    """(h, w, 3) uint8, top row first, converted for OpenGL: with alpha, top row last."""
    return np.ascontiguousarray(cv2.cvtColor(rgb, cv2.COLOR_RGB2RGBA)[::-1])


def _material_block(material: Material) -> bytes:
    """The shader's `Surface` block; a texture is scaled about the image's centre, as by OGRE."""
    shrink = [1 / scale if scale else 1.0 for scale in material.texture_scale]
    offset = [0.5 - 0.5 * factor for factor in shrink]
    return np.array([
        material.ambient,
        material.diffuse,
        (*material.specular[:3], material.shininess),
        (*material.emissive[:3], float(material.lighting)),
        (*shrink, *offset),
    ], np.float32).tobytes()
