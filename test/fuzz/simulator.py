"""The simulator's services and topics, in one process and without a master."""

from __future__ import annotations

import importlib.util
import random
from functools import cache
from pathlib import Path
from types import ModuleType

import rospy
from dynamic_reconfigure.srv import Reconfigure
from hypothesis import strategies as st
from messages import carried, spoil
from target import ROOT, Target

from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.without_master import without_master

ROBOT = "**/turtlebot3_burger/model.sdf"
BOX = ("<sdf version='1.6'><model name='box'><link name='link'><pose>0 0 1 0 0 0</pose><collision "
       "name='c'><geometry><box><size>1 1 1</size></box></geometry></collision></link>"
       "<link name='arm'/><joint name='turn' type='revolute'><parent>link</parent>"
       "<child>arm</child><axis><xyz>0 0 1</xyz></axis></joint></model></sdf>")
URDF = "<robot name='r'><link name='base'/></robot>"
NAMES = ("box", "box::link", "link", "turn", "arm", "box::arm", "sun", "world", "ground_plane",
         "ground_plane::link", "burger", BOX, URDF, "map")
CALLS, STEPS = 4, 20


@cache
def _bench() -> ModuleType:
    path = ROOT / "src/sim/bullet_sim_ros/test/conformance/conftest.py"
    spec = importlib.util.spec_from_file_location("bench_conftest", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def use_simulator(path: Path) -> None:
    """Some calls and messages by the file's seed, and some steps after each."""
    rng = random.Random(path.read_bytes())
    with without_master() as graph:
        bench = _bench().Bench(graph, _bench().GROUND, path.parent, NodeParameters())
        try:
            bench.spawn(BOX)
            bench.simulation.pacer.ahead = lambda _time: 0.0  # or a slow rate lets it wait
            for _ in range(CALLS):
                rng.choice((_call, _send))(bench, rng)
                bench.world.paused = False  # or the steps never come
                bench.run_steps(STEPS)
        finally:
            bench.simulation.close()


def _call(bench, rng: random.Random) -> None:
    name = rng.choice(sorted(bench.graph.services))
    kind, _ = bench.graph.services[name]
    if kind is Reconfigure:  # dynamic_reconfigure's own server takes it apart
        return
    request = carried(spoil(kind._request_class(), rng, NAMES))
    if request is None:
        return
    try:
        answer = bench.call(name, **{slot: getattr(request, slot) for slot in request.__slots__})
        said = getattr(answer, "status_message", "")
    except rospy.ServiceException as error:
        said = str(error)
    if "\n" in said or len(said) > 2000 or said.startswith(ACCIDENTS):
        raise RuntimeError(f"{name} answers {said}")


def _send(bench, rng: random.Random) -> None:
    topics = sorted(bench.subscribed())
    if topics:
        topic = rng.choice(topics)
        message = carried(spoil(bench.subscribed()[topic](), rng, NAMES))
        if message is not None:
            bench.send(topic, message)


# What nobody meant to answer: errors of Python's own, and the engine's.
ACCIDENTS = tuple(f"{name}:" for name in (
    "TypeError", "ValueError", "KeyError", "IndexError", "AttributeError", "ZeroDivisionError",
    "OverflowError", "RuntimeError", "AssertionError", "error", "MemoryError", "LinAlgError"))

TARGETS = (
    Target("simulator", "seed", st.binary(min_size=4, max_size=8), use_simulator, ()),
)
