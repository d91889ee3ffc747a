"""Who talks to whom: a robot's inputs and sensors, and what is wrong there, in plain sentences."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from typing import Any

import rospy

from bullet_sim_ros.topic_faults import (
    COMMANDS,
    SENSORS,
    Graph,
    ask_node,
    mistyped,
    typed,
    unheard,
    unseen,
)
from sim_viewer.registry import watchable
from sim_viewer.tools.graph import without_quiet
from sim_viewer.tools.master import SystemState, simulator_name
from sim_viewer.tools.paced import Paced

DRIVES = COMMANDS | {"ackermann_msgs/AckermannDriveStamped"}
LOOKERS = ("/rosout", "/rqt_", "/rviz")  # nodes that belong to no robot's program
SENSES = SENSORS | {"nav_msgs/Odometry"}
WINDOW = "/windows/"  # in the topic of a program's OpenCV window
MOST_LINES = 30
UNHEARD = frozenset(["/tf", "/tf_static"])  # by nobody: as often as not


@watchable("wiring")
class Wiring(Paced):
    """Sends what `describe` returns."""

    PERIOD = 1.0

    def open(self) -> None:
        self._state: SystemState | None = None
        self._answers: dict[tuple[str, str], dict[str, str]] = {}

    def collect(self) -> Any:
        state, types = self.master.state(), self.master.types()
        if state != self._state:
            self._state, self._answers = state, {}
        return self.changed(describe(state, types, rospy.get_name(), self._ask))

    def _ask(self, node: str, call: str) -> dict[str, str]:
        """Once for each state of the master."""
        if (node, call) not in self._answers:
            self._answers[node, call] = ask_node(node, call)
        return self._answers[node, call]


def describe(state: SystemState, types: dict[str, str], own: str,
             ask: Callable[[str, str], dict[str, str]]) -> dict[str, Any]:
    """`{rows: [{name, type, part, from, to}], faults: [line], loose: [line]}`; this page is `own`.

    `ask` a node for its topics' types, as ask_node does.

    A row is a topic of commands that somebody hears (`part` is `input`) or a sensor's that somebody
    sends; `from` and `to` are nodes without this page's. `loose` are other topics with one end.
    """
    simulator = simulator_name(state)
    seen = without_quiet(state, own, LOOKERS)
    graph = typed(Graph(seen.publishers, seen.subscribers, types), simulator, ask)
    rows = [{"name": topic, "type": graph.types.get(topic, ""), "part": part,
             "from": graph.publishers.get(topic, []), "to": graph.subscribers.get(topic, [])}
            for part, kinds, ends in (("input", DRIVES, graph.subscribers),
                                      ("sensor", SENSES, graph.publishers))
            for topic in sorted(ends)
            if graph.types.get(topic) in kinds and WINDOW not in topic]
    # Commands that nobody hears are a fault, too, while somebody else drives.
    undriven = {topic: nodes for topic, nodes in graph.publishers.items()
                if simulator not in graph.subscribers.get(topic, [])}
    found = [*mistyped(graph), *unheard(replace(graph, publishers=undriven), simulator),
             *unseen(graph, simulator)]
    faults = [*_rivals(rows), *(fault.text % fault.values for fault in found)]
    named = {topic for _which, topic, *_nodes in (fault.key for fault in found)}
    return {"rows": rows, "faults": faults[:MOST_LINES],
            "loose": list(_loose(graph, simulator, named))[:MOST_LINES]}


def _rivals(rows: list[dict[str, Any]]) -> Iterator[str]:
    for row in rows:
        if row["part"] == "input" and len(row["from"]) > 1:
            yield (f"{', '.join(row['from'])} may all send commands on {row['name']}; while they "
                   "do, the robot follows now one, now the other: end all but one (Ctrl-C in its "
                   "terminal, or rosnode kill)")


def _loose(graph: Graph, simulator: str, named: Collection[str]) -> Iterator[str]:
    """Topics with one end, of others than the simulator, without those that are named already."""
    for topic, nodes in sorted(graph.subscribers.items()):
        nodes = [node for node in nodes if node != simulator]
        kind = graph.types.get(topic)
        if nodes and topic not in graph.publishers and topic not in named:
            alike = sorted(other for other in graph.publishers if graph.types.get(other) == kind)
            meant = f"; of this type there are: {', '.join(alike)}" if alike and kind else ""
            yield f"{', '.join(nodes)} waits for {topic}, which nobody sends{meant}"
    for topic, nodes in sorted(graph.publishers.items()):
        nodes = [node for node in nodes if node != simulator]
        if nodes and topic not in graph.subscribers and topic not in named | UNHEARD:
            yield f"{', '.join(nodes)} sends {topic}, which nobody hears"
