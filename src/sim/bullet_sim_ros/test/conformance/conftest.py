"""The whole simulator in one process: real world, real plugins, real services, no master.

What rospy would carry between processes is kept in lists, so that a test of one tag or one field
takes milliseconds. That the real transport works is what the rostest files are for.
"""

from __future__ import annotations

import io
import threading
from collections.abc import Callable, Iterator

import pytest
import rospy

from bullet_sim.formats.loading import load_model, load_world
from bullet_sim.model import Model
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.world import World
from bullet_sim_ros import loop
from bullet_sim_ros.node import open_network
from bullet_sim_ros.package_paths import open_resources
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugins import register_plugins
from bullet_sim_ros.services.models import with_namespace
from bullet_sim_ros.simulation import Simulation
from bullet_sim_ros.without_master import Graph, without_master

GROUND = """<sdf version="1.6"><world name="default">
  <physics type="ode"><max_step_size>0.001</max_step_size>
    <real_time_update_rate>0</real_time_update_rate></physics>
  <include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
</world></sdf>"""
LIMIT = 60.0  # s, wall, for one service call


class Bench:
    """A simulation to try things on. Time passes only in `run`."""

    def __init__(self, graph: Graph, world_text: str, folder, parameters: NodeParameters):
        register_plugins()
        self.graph = graph
        self.resources = open_resources()
        path = folder / "bench.world"
        path.write_text(world_text, encoding="utf-8")
        self.world = World(load_world(path, self.resources), seed=1)
        self.simulation = Simulation(self.world, parameters, self.resources)
        open_network(self.simulation, parameters)

    # --- what a user does

    def run(self, seconds: float) -> None:
        """So much simulated time."""
        self.run_steps(round(seconds / self.world.timestep))

    def run_steps(self, count: int) -> None:
        """So many physics steps."""
        loop.run(self.simulation, count)
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
def graph() -> Iterator[Graph]:
    """An empty ROS graph."""
    with without_master() as made:
        yield made


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
