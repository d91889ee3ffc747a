"""The whole simulator in one process: real world, real plugins, real services, no master.

What rospy would carry between processes is kept in lists, so that a test of one tag or one field
takes milliseconds. That the real transport works is what the rostest files are for.
"""

from __future__ import annotations

import io
import threading
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pytest
import rospy

from bullet_sim.formats import load_model, load_world
from bullet_sim.model import Model
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.world import World
from bullet_sim_ros.package_paths import open_resources
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.services import offer_services
from bullet_sim_ros.services.models import with_namespace
from bullet_sim_ros.simulation import Simulation

GROUND = """<sdf version="1.6"><world name="default">
  <physics type="ode"><max_step_size>0.001</max_step_size>
    <real_time_update_rate>0</real_time_update_rate></physics>
  <include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
</world></sdf>"""
LIMIT = 20.0  # s, wall, for one service call


@dataclass
class Topic:
    """One topic as the graph has it; `messages` are what was published while it was open."""

    kind: type | None = None
    messages: list = field(default_factory=list)
    publishers: list = field(default_factory=list)
    subscribers: list = field(default_factory=list)
    listeners: int = 0  # how many others listen, as get_num_connections tells


class Graph:
    """Topics, services and parameters by resolved name."""

    def __init__(self):
        self.topics: dict[str, Topic] = defaultdict(Topic)
        self.services: dict[str, tuple[type, Callable]] = {}
        self.parameters: dict[str, object] = {}

    def parameter(self, name: str) -> object:
        """A parameter or the tree below a name; KeyError if there is none."""
        name = rospy.resolve_name(name).rstrip("/")
        if name in self.parameters:
            return self.parameters[name]
        tree: dict = {}
        for key, value in self.parameters.items():
            if key.startswith(f"{name}/"):
                *path, last = key[len(name) + 1:].split("/")
                branch = tree
                for part in path:
                    branch = branch.setdefault(part, {})
                branch[last] = value
        if not tree:
            raise KeyError(name)
        return tree


def stand_ins(graph: Graph) -> dict[str, object]:
    """What replaces rospy's own: they write into `graph`."""

    class Publisher:
        def __init__(self, name, data_class, **options):
            self.name, self.resolved_name = name, rospy.resolve_name(name)
            self.options = options
            self._topic = graph.topics[self.resolved_name]
            self._topic.kind = data_class
            self._topic.publishers.append(self)

        def publish(self, *args, **fields):
            made = args and isinstance(args[0], self._topic.kind)
            message = args[0] if made else self._topic.kind(*args, **fields)
            message.serialize(io.BytesIO())  # what cannot be sent is an error here, too
            if self in self._topic.publishers:
                self._topic.messages.append(message)

        def get_num_connections(self):
            return self._topic.listeners

        def unregister(self):
            if self in self._topic.publishers:
                self._topic.publishers.remove(self)

    class Subscriber:
        def __init__(self, name, data_class, callback=None, callback_args=None, **_options):
            self.resolved_name = rospy.resolve_name(name)
            self.callback, self.args = callback, callback_args
            self._topic = graph.topics[self.resolved_name]
            self._topic.kind = self._topic.kind or data_class
            self._topic.subscribers.append(self)

        def take(self, message):
            if self.callback is not None:
                self.callback(message, *([] if self.args is None else [self.args]))

        def get_num_connections(self):
            return 1

        def unregister(self):
            if self in self._topic.subscribers:
                self._topic.subscribers.remove(self)

    class Service:
        def __init__(self, name, service_class, handler, **_options):
            self.resolved_name = rospy.resolve_name(name)
            if self.resolved_name in graph.services:
                raise rospy.ServiceException(f"service [{self.resolved_name}] already registered")
            graph.services[self.resolved_name] = (service_class, handler)

        def shutdown(self, _reason=""):
            graph.services.pop(self.resolved_name, None)

    def get_param(name, *default):
        try:
            return graph.parameter(name)
        except KeyError:
            if default:
                return default[0]
            raise

    def has_param(name):
        try:
            graph.parameter(name)
        except KeyError:
            return False
        return True

    def set_param(name, value):
        graph.parameters[rospy.resolve_name(name)] = value

    return {"Publisher": Publisher, "Subscriber": Subscriber, "Service": Service,
            "get_param": get_param, "has_param": has_param, "set_param": set_param}


class Bench:
    """A simulation to try things on. Time passes only in `run`."""

    def __init__(self, graph: Graph, world_text: str, folder, parameters: NodeParameters):
        self.graph = graph
        self.resources = open_resources()
        path = folder / "bench.world"
        path.write_text(world_text, encoding="utf-8")
        self.world = World(load_world(path, self.resources), seed=1)
        self.simulation = Simulation(self.world, parameters)
        offer_services(self.simulation, self.resources)

    # --- what a user does

    def run(self, seconds: float) -> None:
        """So much simulated time."""
        self.run_steps(round(seconds / self.world.timestep))

    def run_steps(self, count: int) -> None:
        """So many physics steps."""
        self.simulation.run(count)
        self.simulation._drawing.settle()  # pictures that are still being drawn

    def spawn(self, text: str, pose: Pose = IDENTITY, name: str | None = None,
              namespace: str = "") -> Model:
        """A model from URDF or SDF text (a lone `<model>` will do), with its plugins."""
        if text.lstrip().startswith("<model"):
            text = f'<sdf version="1.6">{text}</sdf>'
        description = load_model(text, self.resources, name)
        if namespace:
            description = with_namespace(description, namespace)
        return self.simulation.spawn(description, pose, description.name)

    def delete(self, name: str) -> None:
        """Take a model out."""
        self.simulation.delete(name)

    def listen(self, topic: str, listeners: int = 1) -> list:
        """Its messages from now on: as if somebody had subscribed."""
        found = self.graph.topics[rospy.resolve_name(topic)]
        found.listeners = listeners
        found.messages.clear()
        return found.messages

    def send(self, topic: str, message) -> None:
        """Publish to the simulator; it is taken at the beginning of the next `run`."""
        for subscriber in list(self.graph.topics[rospy.resolve_name(topic)].subscribers):
            subscriber.take(message)

    def call(self, service: str, **fields):
        """Call a service of the simulator; exceptions come back as a client would see them."""
        kind, handler = self.graph.services[rospy.resolve_name(service)]
        request = kind._request_class(**fields)
        request.serialize(io.BytesIO())
        outcome: list = []

        def work() -> None:
            try:
                outcome.append(handler(request))
            except Exception as error:
                outcome.append(error)

        client = threading.Thread(target=work, daemon=True)
        client.start()
        for _ in range(round(LIMIT / 0.01)):
            self.simulation.mailbox.run_pending(0.01)
            if outcome:
                break
        client.join(LIMIT)
        if isinstance(outcome[0], Exception):
            raise outcome[0]
        outcome[0].serialize(io.BytesIO())
        return outcome[0]

    # --- what there is

    def advertised(self) -> dict[str, type]:
        """Topics that somebody publishes, and their types."""
        return {name: topic.kind for name, topic in self.graph.topics.items() if topic.publishers}

    def subscribed(self) -> dict[str, type]:
        """Topics that somebody here listens to, and their types."""
        return {name: topic.kind for name, topic in self.graph.topics.items() if topic.subscribers}


@pytest.fixture
def graph(monkeypatch) -> Graph:
    """An empty ROS graph."""
    made = Graph()
    for name, stand_in in stand_ins(made).items():
        monkeypatch.setattr(rospy, name, stand_in)
    monkeypatch.setattr(rospy.rostime, "_rostime_initialized", True)
    monkeypatch.setattr(rospy.rostime, "_rostime_current", rospy.Time(0))
    monkeypatch.setattr(rospy.names, "_caller_id", "/gazebo")  # what ~ stands for
    return made


@pytest.fixture
def make_bench(graph, tmp_path) -> Iterator[Callable[..., Bench]]:
    """`make_bench(world_text, **node_parameters)`: benches that are closed after the test."""
    made: list[Bench] = []

    def make(world_text: str = GROUND, **parameters) -> Bench:
        made.append(Bench(graph, world_text, tmp_path, NodeParameters(**parameters)))
        return made[-1]

    yield make
    for bench in made:
        bench.simulation.close()


@pytest.fixture
def bench(make_bench) -> Bench:
    """Ground plane, sun, steps of 1 ms, as fast as it goes."""
    return make_bench()
