"""The same scene drawn by PyBullet's own renderers, each with the settings that are its fastest.

Both draw in the size that is asked for, without shadows and without the segmentation mask, which
would be one more pass each. Visual shapes come the way each renderer takes them: TinyRenderer as
arrays, the EGL plugin as files, since it ends the process when it is given arrays (3.2.7). A
surface without a texture gets no texture coordinates: TinyRenderer would paint it with a chequer.
"""

from __future__ import annotations

import importlib.util
import tempfile
from pathlib import Path

import numpy as np

from bullet_sim.meshes.part import MeshPart
from bullet_sim.physics.engine import STDERR, STDOUT, pybullet, quiet
from bullet_sim.pose import Pose, rotate
from bullet_sim.rendering.frame import CameraView, projection_matrix, view_matrix
from bullet_sim.rendering.scene import Node, Scene
from run_session.failure import RunError

PLUGIN_MODULE, PLUGIN_SUFFIX = "eglRenderer", "_eglRendererPlugin"
# m: a plane lies so much lower than the next smaller one, or the two would flicker.
RECESS = 0.002


class PybulletDrawing:
    """One PyBullet client that shows a scene and never steps."""

    def __init__(self, scene: Scene, plugin: bool, fastest: bool = True):
        """`fastest`: with the settings above, else with those that getCameraImage has by itself."""
        self._client = pybullet.connect(pybullet.DIRECT)
        self._renderer = pybullet.ER_TINY_RENDERER
        if plugin:
            self._load_plugin()
            self._renderer = pybullet.ER_BULLET_HARDWARE_OPENGL
        self._ranks = scene.plane_ranks()
        self._settings = {
            "shadow": 0, "lightDirection": _light_direction(scene),
            "flags": pybullet.ER_NO_SEGMENTATION_MASK} if fastest else {}
        self._bodies: list[tuple[Node, int]] = []
        with tempfile.TemporaryDirectory(prefix="bench-") as folder, quiet(STDOUT, STDERR):
            for node in scene.nodes.values():
                for part in node.shape.parts:
                    file = Path(folder, f"{len(self._bodies)}.obj") if plugin else None
                    self._bodies.append((node, self._show(part, file)))

    def place(self) -> None:
        """Put every body where its link is in the scene; no part of the drawing time."""
        for node, body in self._bodies:
            pose = node.pose
            rank = self._ranks.get(node.shape.plane_size, 0)
            pose = Pose((0.0, 0.0, -rank * RECESS)) * pose
            pybullet.resetBasePositionAndOrientation(
                body, pose.position, pose.orientation, physicsClientId=self._client
            )

    def draw(self, view: CameraView) -> np.ndarray:
        """The picture as PyBullet gives it: (height, width, 4) uint8 RGBA."""
        _, _, pixels, _, _ = pybullet.getCameraImage(
            view.width,
            view.height,
            view_matrix(view.pose).T.ravel().tolist(),
            projection_matrix(view).T.ravel().tolist(),
            renderer=self._renderer,
            physicsClientId=self._client,
            **self._settings,
        )
        return np.reshape(pixels, (view.height, view.width, 4))

    def _load_plugin(self) -> None:
        found = importlib.util.find_spec(PLUGIN_MODULE)
        if found is None or found.origin is None:
            raise RunError(f"PyBullet was installed without its plugin {PLUGIN_MODULE}")
        with quiet(STDOUT, STDERR):
            number = pybullet.loadPlugin(
                found.origin, PLUGIN_SUFFIX, physicsClientId=self._client
            )
        if number < 0:
            raise RunError(f"PyBullet's plugin {PLUGIN_MODULE} does not load")

    def _show(self, part: MeshPart, file: Path | None) -> int:
        texture = part.material.texture if part.uv is not None else None
        if file is None:
            shape = _arrays(part, texture is not None)
        else:
            file.write_text(_wavefront(part, texture is not None), encoding="ascii")
            shape = {"fileName": str(file)}
        visual = pybullet.createVisualShape(
            pybullet.GEOM_MESH,
            rgbaColor=part.material.diffuse,
            physicsClientId=self._client,
            **shape,
        )
        body = pybullet.createMultiBody(baseVisualShapeIndex=visual, physicsClientId=self._client)
        if texture is not None:
            number = pybullet.loadTexture(texture, physicsClientId=self._client)
            pybullet.changeVisualShape(
                body, -1, textureUniqueId=number, physicsClientId=self._client
            )
        return body


def _arrays(part: MeshPart, textured: bool) -> dict:
    shape = {
        "vertices": part.vertices.tolist(),
        "normals": part.normals.tolist(),
        "indices": part.faces.ravel().tolist(),
    }
    return {**shape, "uvs": part.uv.tolist()} if textured else shape


def _wavefront(part: MeshPart, textured: bool) -> str:
    """The part as an OBJ file's text; corners count from 1."""
    lines = ["v {:.7g} {:.7g} {:.7g}".format(*corner) for corner in part.vertices]
    lines += ["vn {:.7g} {:.7g} {:.7g}".format(*normal) for normal in part.normals]
    if textured:
        lines += ["vt {:.7g} {:.7g}".format(*corner) for corner in part.uv]
    corner = "{0}/{0}/{0}" if textured else "{0}//{0}"
    lines += ["f " + " ".join(corner.format(i) for i in face) for face in part.faces + 1]
    return "\n".join(lines) + "\n"


def _light_direction(scene: Scene) -> list[float]:
    """Towards the first directional light; straight up if there is none."""
    for light in scene.lights.values():
        if light.type == "directional":
            towards = [-axis for axis in light.direction]
            return list(rotate(light.pose.orientation, towards))
    return [0.0, 0.0, 1.0]
