"""Lower bounds on this machine, to put the other figures in proportion.

A plane of one colour over the whole picture, the least that OpenGL fills one with; a copy of a
depth camera's frame of 1920x1080 in memory; and the same frame over a bare socket of the loopback
interface, as each of its messages goes.
"""

from __future__ import annotations

import socket
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from bullet_sim.description import Material, Plane, Visual
from bullet_sim.pose import Pose
from bullet_sim.profiler import Profiler
from bullet_sim.rendering.frame import CameraView
from bullet_sim.rendering.renderer import open_renderer
from bullet_sim.rendering.scene import Scene
from sim_bench.figures import Figure, figure
from sim_bench.own_process import OwnProcess
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
    say(f"{DEPTH_FRAME / 1e6:.0f} MB in memory, and over a socket")
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
    """Until a thread that waits in the kernel has it all, in memory that it has had before."""
    frame, heard, took = bytes(DEPTH_FRAME), bytearray(DEPTH_FRAME), []
    with (ThreadPoolExecutor(1) as thread, socket.create_server(("127.0.0.1", 0)) as server,
          socket.create_connection(server.getsockname()) as sender, server.accept()[0] as receiver):
        for _ in range(runs + 1):
            start = time.perf_counter()
            all_here = thread.submit(receiver.recv_into, heard, 0, socket.MSG_WAITALL)
            sender.sendall(frame)
            all_here.result()
            took.append(1e3 * (time.perf_counter() - start))
    return took[1:]  # of the first the memory is new
