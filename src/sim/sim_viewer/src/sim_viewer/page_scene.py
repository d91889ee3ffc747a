"""A scene in the form that the page's 3D view needs: links with poses and numbered meshes.

Meshes and textures are numbered, so that the page can load nothing else. GET /mesh/N is one binary,
little-endian: four uint32 (corners n, triangles m, 1 if there is uv, 0), then float32 positions
(n, 3) in m, normals (n, 3), uv (n, 2) with (0, 0) at the lower left, then uint32 corners of
triangles (m, 3). GET /texture/N is an image that browsers can show.
"""

import contextlib
import itertools
import mimetypes
import threading
from collections.abc import Hashable
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from bullet_sim.description import LightDescription, Material, Visual
from bullet_sim.errors import FormatError
from bullet_sim.meshes.images import read_image
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import Pose, rotate
from bullet_sim.rendering.scene import LinkShape, link_shape
from bullet_sim.rendering.scene_text import SceneContent

SHOWN_AS_IS = (".png", ".jpg", ".jpeg", ".bmp", ".gif", ".webp")  # files that browsers can read
NOTHING = {"background": None, "ambient": [1, 1, 1, 1], "sky": False, "lights": [], "links": []}


class Meshes:
    """The shapes of the present scenes, kept as long as one of them uses them. Thread safe."""

    def __init__(self, _node: object = None):
        """Made for a page's node too, which shares one among its modules."""
        self._lock = threading.Lock()
        self._wanted: dict[Hashable, set[tuple[Visual, ...]]] = {}  # by owner
        self._shapes: dict[tuple[Visual, ...], LinkShape] = {}
        self._numbers: dict[MeshPart, int] = {}
        self._parts: dict[int, MeshPart] = {}
        self._textures: dict[int, str] = {}
        self._next = itertools.count(1)

    def shapes(self, links: list[tuple[Visual, ...]], owner: Hashable = None) -> list[LinkShape]:
        """The shapes of links with these visuals; shapes that this owner had before and that no
        owner has now are forgotten.

        Reads files, so it may take a while.
        """
        with self._lock:
            self._wanted[owner] = set(links)
            wanted = dict.fromkeys(itertools.chain(links, *self._wanted.values()))
            self._shapes = {visuals: self._shapes.get(visuals) or link_shape(visuals)
                            for visuals in wanted}
            self._count()
            return [self._shapes[visuals] for visuals in links]

    def forget(self, owner: Hashable) -> None:
        """This owner shows nothing any more."""
        self.shapes([], owner)
        del self._wanted[owner]

    def _count(self) -> None:
        parts = [part for shape in self._shapes.values() for part in shape.parts]
        self._numbers = {part: self._numbers.get(part) or next(self._next) for part in parts}
        self._parts = {number: part for part, number in self._numbers.items()}
        known = {path: number for number, path in self._textures.items()}
        paths = {part.material.texture for part in parts if part.uv is not None} - {None}
        self._textures = {known.get(path) or next(self._next): path for path in sorted(paths)}

    def mesh_number(self, part: MeshPart) -> int:
        """The number by which the page asks for a part of a present shape."""
        return self._numbers[part]

    def texture_numbers(self) -> dict[str, int]:
        """The numbers by which the page asks for image files, by path."""
        return {path: number for number, path in self._textures.items() if Path(path).is_file()}

    def files(self) -> dict[str, tuple[str, bytes]]:
        """Content type and content of all that the page would ask for and can be read, by path."""
        found = {f"mesh/{number}": self.mesh(number) for number in self._parts}
        for number in self.texture_numbers().values():
            with contextlib.suppress(FormatError, OSError):
                found[f"texture/{number}"] = self.texture(number)
        return found

    def mesh(self, number: int) -> tuple[str, bytes]:
        """Content type and content of /mesh/N; KeyError if no present shape has that part."""
        return "application/octet-stream", mesh_bytes(self._parts[number])

    def texture(self, number: int) -> tuple[str, bytes]:
        """Of /texture/N; KeyError likewise; FormatError or OSError if no image can be read."""
        return _texture(self._textures[number])


def mesh_bytes(part: MeshPart) -> bytes:
    """The binary that /mesh/N returns."""
    uv = part.uv if part.uv is not None else np.empty((0, 2))
    head = np.array([len(part.vertices), len(part.faces), part.uv is not None, 0], "<u4")
    arrays = [(part.vertices, "<f4"), (part.normals, "<f4"), (uv, "<f4"), (part.faces, "<u4")]
    return head.tobytes() + b"".join(np.ascontiguousarray(array, kind).tobytes()
                                     for array, kind in arrays)


def _texture(path: str) -> tuple[str, bytes]:
    """Content type and content as browsers can read it; FormatError or OSError."""
    if path.lower().endswith(SHOWN_AS_IS):
        return mimetypes.guess_type(path)[0], Path(path).read_bytes()
    image = read_image(path, cv2.IMREAD_COLOR)
    return "image/png", cv2.imencode(".png", image)[1].tobytes()


def page_scene(content: SceneContent, meshes: Meshes, owner: Hashable = None) -> dict[str, Any]:
    """The scene as JSON data; may take a while, since files are read. Links are called
    `model::link`, or by their own name if they belong to no model. `owner`: see Meshes.shapes."""
    shapes = meshes.shapes([visuals for _, visuals in content.links.values()], owner)
    textures = meshes.texture_numbers()
    sizes = sorted({shape.plane_size for shape in shapes} - {0.0})
    links = []
    for (model, link), shape in zip(content.links, shapes, strict=True):
        pose = content.links[model, link][0]
        links.append({
            "name": f"{model}::{link}" if model else link,
            "model": model,
            "pose": pose_row(pose),
            # Where planes coincide, the larger one is hidden, as in camera images.
            "plane": sizes.index(shape.plane_size) if shape.plane_size else None,
            "parts": _parts(shape, meshes, textures),
        })
    scene = content.description
    return {"background": scene.background, "ambient": scene.ambient, "sky": scene.sky,
            "lights": [_light(light) for light in content.lights], "links": links}


def pose_row(pose: Pose) -> list[float]:
    """x, y, z in m and the quaternion x, y, z, w."""
    return [*pose.position, *pose.orientation]


def _parts(shape: LinkShape, meshes: Meshes, textures: dict[str, int]) -> list[dict[str, Any]]:
    return [{"mesh": meshes.mesh_number(part), "material": _material(part.material, textures)}
            for part in shape.parts]


def _material(material: Material, textures: dict[str, int]) -> dict[str, Any]:
    return {
        "ambient": material.ambient, "diffuse": material.diffuse, "specular": material.specular,
        "emissive": material.emissive, "shininess": material.shininess,
        "lighting": material.lighting, "texture": textures.get(material.texture),
        "texture_scale": material.texture_scale,
    }


def _light(light: LightDescription) -> dict[str, Any]:
    return {
        "type": light.type, "position": light.pose.position,
        "direction": rotate(light.pose.orientation, light.direction),
        "diffuse": light.diffuse, "specular": light.specular, "range": light.range,
        "attenuation": [light.constant, light.linear, light.quadratic],
        "cone": [light.inner_angle, light.outer_angle, light.falloff],
    }
