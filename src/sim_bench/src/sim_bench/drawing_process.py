"""Keeps OpenGL contexts apart, and a crash away from the benchmark: a renderer in a process."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection

import numpy as np

from bullet_sim.model import Model
from bullet_sim.physics.engine import STDOUT
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.world import World
from run_session.failure import RunError
from sim_bench.course import CourseWorld
from sim_bench.pybullet_drawing import PybulletDrawing

OURS, TINY, PLUGIN = "ours", "tiny", "plugin"
SAYS = {OURS: "our renderer", TINY: "TinyRenderer", PLUGIN: "PyBullet's EGL plugin"}
STRIDE = 0.0005  # of a lap, between two pictures: what the waffle drives in a frame's time
START_LIMIT, DRAW_LIMIT = 60.0, 60.0  # s, wall


@dataclass(frozen=True)
class Task:
    """Pictures of one size from one stretch of the course; the first is drawn but not timed.

    The waffle moves on before each, so that no two are alike and nothing can be drawn once for all.
    """

    width: int
    height: int
    lap_share: float  # where on the yellow line the last picture is taken, 0..1
    frames: int  # that are timed
    want_picture: bool = False


@dataclass(frozen=True)
class Answer:
    """What a task cost, and what was seen."""

    seconds: tuple[float, ...]  # wall time of each frame
    picture: np.ndarray | None  # (height, width, 3) uint8 RGB, top row first


class DrawingProcess:
    """One of OURS, TINY and PLUGIN at work; RunError when it cannot or dies."""

    def __init__(self, kind: str):
        self.kind = kind
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(kind, other), daemon=True)
        self._process.start()
        other.close()
        self.name: str = self._receive(START_LIMIT)

    def draw(self, task: Task) -> Answer:
        """Have the task done."""
        self._pipe.send(task)
        return self._receive(DRAW_LIMIT * (task.frames + 1))

    def close(self) -> None:
        """End the process."""
        self._pipe.close()
        self._process.join(2.0)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()

    def _receive(self, limit: float) -> object:
        try:
            if not self._pipe.poll(limit):
                self.close()
                raise RunError(f"{SAYS[self.kind]} did not answer within {limit:.0f} s")
            answer = self._pipe.recv()
        except (EOFError, ConnectionError):
            self._process.join(2.0)
            code = self._process.exitcode
            raise RunError(f"{SAYS[self.kind]} died (exit code {code})") from None
        if isinstance(answer, Exception):
            self.close()
            raise RunError(f"{SAYS[self.kind]} does not start: {answer}")
        return answer


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


def _serve(kind: str, pipe: Connection) -> None:
    """The process: tasks in, answers out, until the other side closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who started us closes the pipe
    os.dup2(os.open(os.devnull, os.O_WRONLY), STDOUT)  # the plugin prints while it draws
    try:
        course = CourseWorld()
        waffle = course.spawn_waffle()
        drawing = _open(kind, course.world)
    except Exception as error:  # whatever it is, the other side says it
        pipe.send(RunError(" ".join(str(error).split()) or type(error).__name__))
        return
    pipe.send(getattr(drawing, "name", SAYS[kind]))
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        pipe.send(_timed(task, drawing, course, waffle))


def _open(kind: str, world: World) -> _OurDrawing | PybulletDrawing:
    if kind == OURS:
        return _OurDrawing(world)
    return PybulletDrawing(world.update_scene(), plugin=kind == PLUGIN)


def _timed(task: Task, drawing: _OurDrawing | PybulletDrawing, course: CourseWorld,
           waffle: Model) -> Answer:
    seconds = []
    for left in range(task.frames, -1, -1):
        course.put_on_line(waffle, task.lap_share - left * STRIDE)
        course.world.update_scene()
        drawing.place()
        view = course.view(waffle, task.width, task.height)
        start = time.perf_counter()
        picture = drawing.draw(view)
        seconds.append(time.perf_counter() - start)
    if not task.want_picture:
        return Answer(tuple(seconds[1:]), None)
    return Answer(tuple(seconds[1:]), np.ascontiguousarray(picture[..., :3], np.uint8))
