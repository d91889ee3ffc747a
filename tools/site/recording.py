"""What plugins and controllers read, offer and hear, as seen when they load in the simulator."""

from __future__ import annotations

import functools
import importlib.util
import inspect
import logging
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from unittest import mock

import rospy

from bullet_sim.control.parameters import REQUIRED, ControllerParameters
from bullet_sim.errors import PluginError
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.without_master import Graph, without_master

TESTS = Path(__file__).resolve().parents[2] / "src/sim/bullet_sim_ros/test/conformance"


@dataclass
class Seen:
    """Of one plugin or controller; names are paths, `joint/name`."""

    read: dict[str, tuple[bool, object]] = field(default_factory=dict)  # whether a number; default
    published: dict[str, str] = field(default_factory=dict)  # topic -> type
    heard: dict[str, str] = field(default_factory=dict)
    served: dict[str, str] = field(default_factory=dict)


def test_module(name: str) -> ModuleType:
    """A file of the simulator's conformance tests."""
    spec = importlib.util.spec_from_file_location(f"conformance_{name}", TESTS / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@contextmanager
def bench() -> Iterator[tuple[object, Graph]]:
    """The tests' simulator in one process, without a master: its Bench, and its ROS graph.

    Beside what these stand in for, actionlib needs search_param and a timer.
    """
    with without_master() as graph, tempfile.TemporaryDirectory() as folder, \
            mock.patch.object(rospy, "search_param", lambda _name: None), \
            mock.patch.object(rospy, "Timer"), \
            mock.patch.object(logging.getLogger("bullet_sim"), "propagate", False):
        tests = test_module("conftest")
        made = tests.Bench(graph, tests.GROUND, Path(folder), NodeParameters())
        try:
            yield made, graph
        finally:
            made.simulation.close()


@contextmanager
def recorded(graph: Graph, kind: type = PluginParameters) -> Iterator[Seen]:
    """Within `with`: what is read by an object of `kind`, and how the graph grows."""
    seen, inside = Seen(), []
    for topic in [name for name, topic in graph.topics.items()
                  if not (topic.publishers or topic.subscribers)]:
        del graph.topics[topic]  # it would keep its type of an earlier example
    before = offered(graph)

    def watched(own: Callable) -> Callable:
        @functools.wraps(own)
        def reader(self, *args, **options):
            if not inside:
                given = inspect.signature(own).bind(self, *args, **options)
                given.apply_defaults()
                path, numeric, default = _note(own, given.arguments)
                was_numeric, first = seen.read.get(path, (numeric, default))
                seen.read[path] = (  # some are first required, then read as a number
                    was_numeric or numeric, REQUIRED if default is REQUIRED else first)
            inside.append(own)
            try:
                return own(self, *args, **options)
            finally:
                inside.pop()
        return reader

    with mock.patch.multiple(kind, **{name: watched(own) for name, own in vars(kind).items()
                                      if name in READERS}):
        yield seen
    for side, kinds in offered(graph).items():
        getattr(seen, side).update({name: kinds[name] for name in kinds
                                    if name not in before[side]})


def offered(graph: Graph) -> dict[str, dict[str, str]]:
    """What a graph has, as in Seen: names and types."""
    return {"published": {name: topic.kind._type for name, topic in graph.topics.items()
                          if topic.publishers},
            "heard": {name: topic.kind._type for name, topic in graph.topics.items()
                      if topic.subscribers},
            "served": {name: kind._type for name, (kind, _call) in graph.services.items()}}


# How a reader is called, whether it reads numbers, and its default where its arguments have none.
READERS = {"text": (False, REQUIRED), "required": (False, REQUIRED), "flag": (False, REQUIRED),
           "topic": (False, ""), "namespace": (False, ""), "texts": (False, ""),
           "pair": (False, REQUIRED), "value": (False, REQUIRED), "number": (True, REQUIRED),
           "bound": (True, REQUIRED), "numbers": (True, REQUIRED), "deviation": (True, 0.0),
           "vector": (True, (0.0, 0.0, 0.0))}


def _note(own: Callable, given: dict) -> tuple[str, bool, object]:
    """What a call of a reader reads, whether it is a number, and its default."""
    numeric, default = READERS[own.__name__]
    name = given.get("tag", given.get("name", "robotNamespace"))
    reader = given["self"]
    above = (reader._path if isinstance(reader, PluginParameters)
             else reader.namespace.split("/")[3:])
    return "/".join([*above, name]), numeric, given.get("default", given.get("missing", default))


def watched_plugin(library: str, made: tuple[object, Graph]) -> tuple[str, Seen]:
    """The model of the tests that has this plugin, and what is seen when it is loaded.

    Its link is called `chassis`, so that a default that is a link's name is told from others, if
    the plugin does not look for the tests' base_footprint. PluginError if it is not loaded.
    """
    tests = test_module("test_tags_of_every_plugin")
    simulator, graph = made
    for link in ("chassis", "base_footprint"):
        text = tests.robot(library, tests.NEEDS.get(library, "")).replace("base_footprint", link)
        with recorded(graph) as seen, _errors() as errors:
            simulator.spawn(text)
        simulator.delete("bot")
        if not errors:
            return text, seen
    raise PluginError(f"{library}: {errors[0]}")


def watched_controller(kind: str, example: dict, made: tuple[object, Graph]) -> Seen:
    """What is seen when a controller of a robot is loaded and started; PluginError if it is not.

    `example`: its parameters, by the robot: `arm` or `base`.
    """
    simulator, graph = made
    tests = test_module("test_base_controllers")
    interface = kind.partition("_")[0].capitalize()
    (robot, parameters), = example.items()
    text = base(tests) if robot == "base" else test_module("test_controllers_in_groups").robot(
        interface if interface in ("Effort", "Velocity") else "Position")
    graph.parameters.clear()
    graph.parameters["/robot_description"] = text
    tests.configure(graph, "my_controller", type=kind, **flat(parameters))
    simulator.spawn(text, tests.Pose((0, 0, 0.1)))
    simulator.run(0.1)
    try:
        with recorded(graph, ControllerParameters) as seen, _errors() as errors:
            tests.run(simulator, graph, "my_controller")
    except AssertionError:
        raise PluginError(f"{kind}: {(errors or ['not started'])[0]}") from None
    finally:
        simulator.delete("r")
    seen.read.pop("type", None)
    return seen


def base(tests: ModuleType) -> str:
    """A body on four steered wheels, of the parts that the tests' robots are made of."""
    parts = tests.body()
    for corner, (x, y) in tests.CORNERS.items():
        steer = f"{corner}_steer"
        parts += tests.link(f"{steer}_link", 0.3, 0.05, "") + tests.joint(
            steer, "base_link", f"{steer}_link", (x * 0.2, y * 0.2, 0), (0, 0, 1), "revolute",
            '<limit lower="-0.8" upper="0.8" effort="20" velocity="10"/>')
        parts += tests.TRANSMISSION.format(steer, "Position")
        parts += tests.wheel(corner, f"{steer}_link", (0, 0, 0), "Velocity")
    return tests.robot(parts)


def flat(tree: dict, above: str = "") -> dict[str, object]:
    """Values by path, as the parameter server takes them."""
    found: dict[str, object] = {}
    for name, value in tree.items():
        found |= (flat(value, f"{above}{name}/") if isinstance(value, dict)
                  else {above + name: value})
    return found


@contextmanager
def _errors() -> Iterator[list[str]]:
    """Lines that are logged as errors within `with`."""
    found: list[str] = []
    handler = logging.Handler(logging.ERROR)
    handler.emit = lambda record: found.append(record.getMessage())
    logger = logging.getLogger("bullet_sim")
    logger.addHandler(handler)
    try:
        yield found
    finally:
        logger.removeHandler(handler)
