"""One frame of the course drawn by our renderer, and by PyBullet's two, from the same places."""

from __future__ import annotations

import importlib.util
import tempfile
import time
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bullet_sim.meshes.part import MeshPart
from bullet_sim.model import Model
from bullet_sim.physics.engine import STDERR, STDOUT, pybullet, quiet
from bullet_sim.pose import Pose, rotate
from bullet_sim.rendering.frame import CameraView, projection_matrix, view_matrix
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.rendering.scene import Node, Scene
from bullet_sim.world import World
from run_session.failure import RunError
from sim_bench.course import CourseWorld

OURS, TINY, PLUGIN = "ours", "tiny", "plugin"
SAYS = {OURS: "our renderer", TINY: "TinyRenderer", PLUGIN: "PyBullet's EGL plugin"}
STRIDE = 0.0005  # of a lap, between two pictures: what the waffle drives in a frame's time
PLUGIN_MODULE, PLUGIN_SUFFIX = "eglRenderer", "_eglRendererPlugin"
# m: a plane lies so much lower than the next smaller one, or the two would flicker.
RECESS = 0.002


class Task(NamedTuple):
    """Pictures of one size from one stretch of the course; the first is drawn but not timed.

    The waffle moves on before each, so that no two are alike and nothing can be drawn once for all.
    """

    width: int
    height: int
    lap_share: float  # where on the yellow line the last picture is taken, 0..1
    frames: int  # that are timed


def renderer_name(kind: str) -> str:
    """Opens that renderer in this process."""
    return getattr(_opened(kind)[2], "name", SAYS[kind])


def draw(kind: str, task: Task) -> tuple[list[float], np.ndarray]:
    """Wall s of each timed frame, and the last picture: (height, width, 3) uint8 RGB."""
    course, waffle, drawing = _opened(kind)
    seconds = []
    for left in range(task.frames, -1, -1):
        course.put_on_line(waffle, task.lap_share - left * STRIDE)
        course.world.update_scene()
        drawing.place()
        view = course.view(waffle, task.width, task.height)
        start = time.perf_counter()
        picture = drawing.draw(view)
        seconds.append(time.perf_counter() - start)
    return seconds[1:], np.ascontiguousarray(picture[..., :3], np.uint8)


class PybulletDrawing:
    """The same scene drawn by one of PyBullet's own renderers, by a client that never steps.

    It draws in the size that is asked for; with the settings that are its fastest, without shadows
    and without the segmentation mask, which would be one more pass each. Shapes are files: the EGL
    plugin ends the process when it is given arrays (3.2.7). A surface without a texture gets no
    texture coordinates: TinyRenderer would paint it with a chequer.
    """

    def __init__(self, scene: Scene, plugin: bool, fastest: bool = True):
        """`fastest`: with those settings, else with those that getCameraImage has by itself."""
        self._client = pybullet.connect(pybullet.DIRECT)
        self._renderer = pybullet.ER_TINY_RENDERER
        if plugin:
            self._load_plugin()
            self._renderer = pybullet.ER_BULLET_HARDWARE_OPENGL
        self._ranks = scene.plane_ranks()
        self._settings = {
            "shadow": 0, "lightDirection": _light_direction(scene),
            "flags": pybullet.ER_NO_SEGMENTATION_MASK} if fastest else {}
        with tempfile.TemporaryDirectory(prefix="bench-") as folder, quiet(STDOUT, STDERR):
            self._bodies: list[tuple[Node, int]] = [
                (node, self._show(part, Path(folder, f"{id(part)}.obj")))
                for node in scene.nodes.values() for part in node.shape.parts]

    def place(self) -> None:
        """Put every body where its link is in the scene; no part of the drawing time."""
        for node, body in self._bodies:
            rank = self._ranks.get(node.shape.plane_size, 0)
            pose = Pose((0.0, 0.0, -rank * RECESS)) * node.pose
            pybullet.resetBasePositionAndOrientation(
                body, pose.position, pose.orientation, physicsClientId=self._client)

    def draw(self, view: CameraView) -> np.ndarray:
        """The picture as PyBullet gives it: (height, width, 4) uint8 RGBA."""
        pixels = pybullet.getCameraImage(
            view.width, view.height, view_matrix(view.pose).T.ravel().tolist(),
            projection_matrix(view).T.ravel().tolist(), renderer=self._renderer,
            physicsClientId=self._client, **self._settings)[2]
        return np.reshape(pixels, (view.height, view.width, 4))

    def _load_plugin(self) -> None:
        found = importlib.util.find_spec(PLUGIN_MODULE)
        if found is None or found.origin is None:
            raise RunError(f"PyBullet was installed without its plugin {PLUGIN_MODULE}")
        with quiet(STDOUT, STDERR):
            number = pybullet.loadPlugin(found.origin, PLUGIN_SUFFIX, physicsClientId=self._client)
        if number < 0:
            raise RunError(f"PyBullet's plugin {PLUGIN_MODULE} does not load")

    def _show(self, part: MeshPart, file: Path) -> int:
        client = {"physicsClientId": self._client}
        texture = part.material.texture if part.uv is not None else None
        file.write_text(_wavefront(part, texture is not None), encoding="ascii")
        visual = pybullet.createVisualShape(
            pybullet.GEOM_MESH, fileName=str(file), rgbaColor=part.material.diffuse, **client)
        body = pybullet.createMultiBody(baseVisualShapeIndex=visual, **client)
        if texture is not None:
            number = pybullet.loadTexture(texture, **client)
            pybullet.changeVisualShape(body, -1, textureUniqueId=number, **client)
        return body


class _OurDrawing:
    """What the simulator does for a frame: the scene as it stands now, drawn and read back."""

    def __init__(self, world: World):
        self._world = world
        self._renderer = open_renderer()
        self.name = self._renderer.name

    def draw(self, view: CameraView) -> np.ndarray:
        return self._renderer.draw(self._world.update_scene().frozen(), view).rgb

    def place(self) -> None:
        """Nothing: the scene is brought up to date within the time of a frame."""


@lru_cache
def _opened(kind: str) -> tuple[CourseWorld, Model, _OurDrawing | PybulletDrawing]:
    course = CourseWorld()
    waffle = course.spawn_waffle()
    drawing = (_OurDrawing(course.world) if kind == OURS else
               PybulletDrawing(course.world.update_scene(), plugin=kind == PLUGIN))
    return course, waffle, drawing


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
            return list(rotate(light.pose.orientation, [-axis for axis in light.direction]))
    return [0.0, 0.0, 1.0]
