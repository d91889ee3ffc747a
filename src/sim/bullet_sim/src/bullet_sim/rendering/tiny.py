"""The fallback if OpenGL does not work: PyBullet's TinyRenderer, slow, with the same cameras.

One directional light, no filtering of textures, no blending, no fog, no sky, only textures in
files; emissive surfaces just have that colour.
It has its own physics client that never steps: bodies without mass stand where links are.
"""

import logging
from collections.abc import Iterator

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from bullet_sim.description import Material
from bullet_sim.errors import FormatError
from bullet_sim.meshes.images import check_image
from bullet_sim.meshes.part import MeshPart
from bullet_sim.pose import Pose, rotate
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.frame import LARGEST_PX, CameraView, Frame
from bullet_sim.rendering.projection import metres_from_depth, projection_matrix, view_matrix
from bullet_sim.rendering.scene import LinkKey, LinkShape, SceneState

log = logging.getLogger(__name__)

# PyBullet takes 8 MiB per call; so many triangles with unshared corners stay well below.
_TRIANGLES_PER_BODY = 20_000
_RECESS = 0.002  # m, of a plane behind the next smaller one; depth is no finer near the horizon

_Placed = tuple[LinkKey, LinkShape]  # a link with its look; the same link may be there with another


class TinyRenderer:
    """See `renderer.Renderer`."""

    name = "PyBullet's TinyRenderer"
    largest_px = LARGEST_PX  # with much more, it ends the whole process

    def __init__(self, profiler: Profiler | None = None) -> None:
        self._profiler = profiler or Profiler()
        self._client = BulletClient(pybullet.DIRECT)
        self._version = -1
        self._bodies: dict[_Placed, list[int]] = {}
        self._poses: dict[_Placed, Pose] = {}
        self._ranks: dict[float, int] = {}  # of planes, by size
        self._textures: dict[str, int] = {}

    def draw(self, scene: SceneState, view: CameraView, depth: bool = False) -> Frame:
        """RGB, and depth if wanted."""
        with self._profiler.measure("draw"):
            self._mirror(scene)
            width, height, pixels, raw, _ = self._client.getCameraImage(
                view.width,
                view.height,
                _columns(view_matrix(view.pose)),
                _columns(_half_pixel(view) @ projection_matrix(view)),
                shadow=0,
                flags=pybullet.ER_NO_SEGMENTATION_MASK,
                renderer=pybullet.ER_TINY_RENDERER,
                **_light(scene),
            )
        with self._profiler.measure("convert"):
            rgb = np.ascontiguousarray(np.reshape(pixels, (height, width, 4))[..., :3], np.uint8)
            metres = metres_from_depth(
                np.reshape(raw, (height, width)).astype(np.float32), view.near, view.far
            )
            background = metres > view.far * 0.99  # TinyRenderer's background depth is nearly `far`
            colour = np.array(scene.description.background[:3]) * 255 + 0.5
            rgb[background] = np.clip(colour, 0, 255)
            metres[background] = np.inf
        return Frame(rgb, metres if depth else None)

    def trim(self) -> None:
        """It only keeps the last image's memory, and the bodies visible in that."""

    def close(self) -> None:
        self._client.disconnect()

    def _mirror(self, scene: SceneState) -> None:
        """Make the client's bodies match the scene."""
        current = {(key, node.shape): node.pose for key, node in scene.nodes.items()}
        if scene.version != self._version:
            for placed in [placed for placed in self._bodies if placed not in current]:
                self._remove(placed)
            for placed in [placed for placed in current if placed not in self._bodies]:
                pieces = [piece for part in placed[1].parts for piece in _pieces(part)]
                self._bodies[placed] = [self._body(piece) for piece in pieces]
            self._version = scene.version
            self._ranks = scene.plane_ranks()
            self._poses.clear()  # ranks move planes
        for placed, pose in current.items():
            if self._poses.get(placed) is not pose:
                self._poses[placed] = pose
                self._place(placed, pose)

    def _remove(self, placed: _Placed) -> None:
        for body in self._bodies.pop(placed):
            self._client.removeBody(body)

    def _place(self, placed: _Placed, pose: Pose) -> None:
        shape = placed[1]
        rank = self._ranks.get(shape.plane_size, 0)
        if rank:
            normal = shape.parts[0].normals[0].astype(float)
            pose = pose * Pose(tuple(-rank * _RECESS * normal))
        for body in self._bodies[placed]:
            self._client.resetBasePositionAndOrientation(body, pose.position, pose.orientation)

    def _body(self, part: MeshPart) -> int:
        material = part.material
        arrays = {
            "vertices": part.vertices.tolist(),
            "normals": part.normals.tolist(),
            "indices": part.faces.ravel().tolist(),
        }
        if part.uv is not None:
            arrays["uvs"] = _scaled_uv(part.uv, material).tolist()
        visual = self._client.createVisualShape(
            pybullet.GEOM_MESH, rgbaColor=_colour(material), **arrays)
        body = self._client.createMultiBody(baseVisualShapeIndex=visual)
        if material.texture is not None and part.uv is not None:
            self._paint(body, material.texture)
        return body

    def _paint(self, body: int, path: str) -> None:
        if path not in self._textures:
            try:
                check_image(path)
                texture = self._client.loadTexture(path)
            except (pybullet.error, FormatError):
                log.warning("texture %s is left out: TinyRenderer cannot read it", path)
                texture = -1
            self._textures[path] = texture
        if self._textures[path] >= 0:
            self._client.changeVisualShape(body, -1, textureUniqueId=self._textures[path])


def _pieces(part: MeshPart) -> Iterator[MeshPart]:
    """The part itself, or pieces with their own corners if it is too large for one call."""
    if len(part.faces) <= _TRIANGLES_PER_BODY:
        yield part
        return
    for start in range(0, len(part.faces), _TRIANGLES_PER_BODY):
        corners = part.faces[start:start + _TRIANGLES_PER_BODY].ravel()
        yield MeshPart(
            vertices=part.vertices[corners],
            normals=part.normals[corners],
            uv=None if part.uv is None else part.uv[corners],
            faces=np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
            material=part.material,
        )


def _scaled_uv(uv: np.ndarray, material: Material) -> np.ndarray:
    scale = np.array([factor or 1.0 for factor in material.texture_scale])
    return (uv - 0.5) / scale + 0.5


def _colour(material: Material) -> tuple[float, ...]:
    """Its diffuse or its emissive colour, whichever is brighter in a channel."""
    pairs = zip(material.diffuse[:3], material.emissive[:3], strict=True)
    return (*(max(pair) for pair in pairs), material.diffuse[3])


def _light(scene: SceneState) -> dict:
    """TinyRenderer's one light: the first directional one, else the first, else ambient alone."""
    lights = sorted(scene.lights.values(), key=lambda light: light.type != "directional")
    ambient = float(np.mean(scene.description.ambient[:3]))
    settings = {"lightAmbientCoeff": ambient, "lightSpecularCoeff": 0.0, "lightDiffuseCoeff": 0.0}
    if lights:
        towards = rotate(lights[0].pose.orientation, [-axis for axis in lights[0].direction])
        settings["lightDirection"] = list(towards)
        settings["lightDiffuseCoeff"] = float(np.mean(lights[0].diffuse[:3]))
    return settings


def _half_pixel(view: CameraView) -> np.ndarray:
    """TinyRenderer takes a pixel's corner for its centre: a shift corrects that."""
    shift = np.eye(4)
    shift[0, 3], shift[1, 3] = -1 / view.width, -1 / view.height
    return shift


def _columns(matrix: np.ndarray) -> list[float]:
    return matrix.T.ravel().tolist()
