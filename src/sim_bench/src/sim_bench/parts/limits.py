"""Lower bounds on this machine, to put the other figures in proportion.

A plane of one colour over the whole picture, the least that OpenGL fills one with; a copy of a
depth camera's frame of 1920x1080 in memory; and the same frame from one process to another over a
bare socket of the loopback interface, as each of its messages goes.
"""

from __future__ import annotations

import multiprocessing
import socket
import time

import numpy as np

from bullet_sim.description import Material, Plane, Visual
from bullet_sim.pose import Pose
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.rendering.scene import Scene
from sim_bench.figures import Figure, figure
from sim_bench.own_process import LIMIT, OwnProcess
from sim_bench.settings import Settings, say

SIZES = ((640, 480), (1920, 1080))  # px
DEPTH_FRAME = 1920 * 1080 * (3 + 4 + 16)  # bytes of colour, depth and points
RUNS, PICTURES = 5, 10


def measure(settings: Settings) -> list[Figure]:
    """Milliseconds on the wall; `_cpu`: of processor time, of all threads together."""
    say("a picture of one colour")
    runs, found = settings.runs(RUNS), []
    with OwnProcess("pictures of one colour") as drawing:
        for width, height in SIZES:
            ((wall, cpu),) = drawing.call(_flat_pictures, (width, height), runs)
            found += [figure(f"flat_picture.{width}x{height}", "ms", wall),
                      figure(f"flat_picture_cpu.{width}x{height}", "ms", cpu)]
    say(f"{DEPTH_FRAME / 1e6:.0f} MB in memory, and from process to process")
    return [*found, figure("depth_frame.copy", "ms", _copies(runs)),
            figure("depth_frame.loopback", "ms", _loopback(runs))]


def _flat_pictures(size: tuple[int, int], runs: int) -> tuple[list[float], list[float]]:
    scene = Scene()
    floor = Visual("floor", Plane((0.0, 0.0, 1.0), (20.0, 20.0)), material=Material(lighting=False))
    scene.add_link(("flat", "link"), (floor,), Pose())
    down = Pose.from_xyz_rpy((0.0, 0.0, 1.0), (0.0, np.pi / 2, 0.0))
    view = CameraView(*size, 1.0, 0.05, 50.0, down)
    profiler = Profiler()
    renderer, wall, cpu = open_renderer(profiler=profiler), [], []
    renderer.draw(scene.frozen(), view)
    for _ in range(runs):
        began, busy = profiler.totals()["draw"], 0.0
        for _ in range(PICTURES):
            start = time.process_time()
            renderer.draw(scene.frozen(), view)
            busy += time.process_time() - start
        wall.append(1e3 * (profiler.totals()["draw"] - began) / PICTURES)
        cpu.append(1e3 * busy / PICTURES)
    renderer.close()
    return wall, cpu


def _copies(runs: int) -> list[float]:
    source = np.ones(DEPTH_FRAME, np.uint8)
    target = source.copy()
    took = []
    for _ in range(runs):
        start = time.perf_counter()
        np.copyto(target, source)
        took.append(1e3 * (time.perf_counter() - start))
    return took


def _loopback(runs: int) -> list[float]:
    """Until the other process has it all, in memory that it has had before."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        reader = multiprocessing.get_context("spawn").Process(
            target=_receive, args=(server.getsockname()[1],), daemon=True)
        reader.start()
        server.settimeout(LIMIT)
        connection, _ = server.accept()
    frame, took = bytes(DEPTH_FRAME), []
    with connection:
        connection.settimeout(LIMIT)
        for _ in range(runs + 1):
            start = time.perf_counter()
            connection.sendall(frame)
            connection.recv(1)
            took.append(1e3 * (time.perf_counter() - start))
    reader.join(LIMIT)
    return took[1:]  # of the first the memory is new


def _receive(port: int) -> None:
    frame = memoryview(bytearray(DEPTH_FRAME))
    with socket.create_connection(("127.0.0.1", port)) as connection:
        while True:
            filled = 0
            while filled < DEPTH_FRAME:
                got = connection.recv_into(frame[filled:])
                if got == 0:
                    return
                filled += got
            connection.sendall(b"k")
