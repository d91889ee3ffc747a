"""What plugins and controllers read, offer and hear, as seen when they load in the simulator."""

from __future__ import annotations

import functools
import importlib.util
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

    read: dict[str, tuple[str, object]] = field(default_factory=dict)  # name -> kind, default
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
    before = (_open(graph, "publishers"), _open(graph, "subscribers"), dict(graph.services))

    def watch(name: str) -> Callable:
        own = getattr(kind, name)

        @functools.wraps(own)
        def reader(self, *args, **options):
            if not inside and (note := _note(self, name, args, options)):
                name_read, (kind_read, default) = note
                kind_before, default_before = seen.read.get(name_read, note[1])
                seen.read[name_read] = (  # first required, then read as a number
                    kind_read if kind_before == "text" else kind_before,
                    REQUIRED if default is REQUIRED else default_before)
            inside.append(name)
            try:
                return own(self, *args, **options)
            finally:
                inside.pop()
        return reader

    readers = [name for name in _DEFAULTS if name in vars(kind)]
    kept = {name: getattr(kind, name) for name in readers}
    for name in readers:
        setattr(kind, name, watch(name))
    try:
        yield seen
    finally:
        for name, own in kept.items():
            setattr(kind, name, own)
        for found, side, old in ((seen.published, "publishers", before[0]),
                                 (seen.heard, "subscribers", before[1])):
            found.update({topic: kind for topic, kind in _open(graph, side).items()
                          if topic not in old})
        seen.served.update({service: made[0]._type for service, made in graph.services.items()
                            if service not in before[2]})


# How a reader is called -> what is read, and the default where its arguments have none.
_DEFAULTS = {"text": ("text", ""), "required": ("text", REQUIRED), "number": ("number", None),
             "bound": ("number", None), "numbers": ("numbers", REQUIRED), "texts": ("texts", ""),
             "deviation": ("number", 0.0), "vector": ("numbers", (0.0, 0.0, 0.0)),
             "flag": ("flag", REQUIRED), "topic": ("text", ""), "namespace": ("text", ""),
             "pair": ("texts", REQUIRED), "value": ("text", REQUIRED)}


def _note(reader, method: str, args: tuple, options: dict) -> tuple[str, tuple] | None:
    kind, default = _DEFAULTS[method]
    if method == "namespace":
        return "robotNamespace", (kind, options.get("missing", args[0] if args else ""))
    if method == "topic":
        return options.get("tag", args[1] if len(args) > 1 else "topicName"), (kind, args[0])
    name = args[0]
    given = args[2:] if method == "numbers" and isinstance(reader, ControllerParameters) \
        else () if method == "pair" else args[1:]
    default = options.get("default", given[0] if given else default)
    if isinstance(reader, ControllerParameters):
        default = REQUIRED if default in ("", None) and not given else default
        path = [*reader.namespace.split("/")[3:], name]
    else:
        path = [*reader._path, name]
    return "/".join(path), (kind, default)


def _open(graph: Graph, side: str) -> dict[str, str]:
    return {name: topic.kind._type for name, topic in graph.topics.items() if getattr(topic, side)}


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
