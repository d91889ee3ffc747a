"""The graph of nodes and topics, laid out as in rqt_graph."""

from collections import defaultdict
from typing import Any

import rospy

from sim_viewer.drive import GUARD
from sim_viewer.registry import Refused, argument, watchable
from sim_viewer.tools.graph_layout import LayoutError, layout
from sim_viewer.tools.master import SystemState
from sim_viewer.tools.paced import Paced

VIEWS = ("nodes", "active", "all")  # rqt_graph's Nodes only, Nodes/Topics (active), (all)
QUIET_TOPICS = frozenset(["/rosout", "/rosout_agg", "/clock", "/statistics"])
QUIET_ENDINGS = ("/parameter_descriptions", "/parameter_updates", "/bond")
QUIET_NODES = ("/rosout", "/rqt_", "/rviz", "/rostopic_")
MOST_EDGES = 1500

Flow = tuple[str, str, str]  # "" for a missing end: publisher, topic, subscriber


@watchable("graph")
class Graph(Paced):
    """Sends `{size, nodes: [{id, name, topic, box}], edges: [{from, to, topics, curve}]}`."""

    PERIOD = 2.0

    def __init__(self, context: Any, args: dict[str, Any], send: Any):
        super().__init__(context, args, send)
        self._view = argument(args, "view", str, "active")
        self._quiet = argument(args, "quiet", bool, True)
        self._text = argument(args, "text", str, "")
        if self._view not in VIEWS:
            raise Refused(f"view is {self._view!r}; there are {', '.join(VIEWS)}")

    def collect(self) -> Any:
        state = self.changed(self.master.state())
        if state is None:
            return None
        return draw(state, self._view, self._quiet, self._text, rospy.get_name())


def draw(state: SystemState, view: str = "active", quiet: bool = True, text: str = "",
         own: str = "") -> dict[str, Any]:
    """The drawing of `state`, in px as in `Layout`.

    `quiet` leaves out nodes and topics that every system has, and the node `own` with its guard.
    Refused if the graph is too large, or cannot be laid out.
    """
    if quiet:
        state = _without_quiet(state, own)
    flows = _flows(state)
    if text:
        flows = [flow for flow in flows if any(text in name for name in flow)]
    edges = _edges(flows, view)
    if len(edges) > MOST_EDGES:
        raise Refused(f"{len(edges)} arrows are more than can be drawn; filter by part of a name")
    alone = [] if text else _nodes(state)
    ids = {_node(name) for name in alone} | {end for edge in edges for end in edge}
    try:
        plan = layout({one: one[1:] for one in ids}, edges)
    except LayoutError as error:
        raise Refused(str(error)) from None
    return {
        "size": plan.size,
        "nodes": [{"id": one, "name": one[1:], "topic": one[0] == "t", "box": plan.boxes[one]}
                  for one in sorted(ids)],
        "edges": [{"from": edge[0], "to": edge[1], "topics": sorted(topics),
                   "curve": plan.curves[edge]} for edge, topics in sorted(edges.items())],
    }


def _flows(state: SystemState) -> list[Flow]:
    """Every pair of a publisher and a subscriber, and topics with one side only."""
    found = []
    for topic in sorted({*state.publishers, *state.subscribers}):
        for source in state.publishers.get(topic, [""]):
            for target in state.subscribers.get(topic, [""]):
                found.append((source, topic, target))
    return found


def _without_quiet(state: SystemState, own: str) -> SystemState:
    def filtered(part: dict[str, list[str]]) -> dict[str, list[str]]:
        kept = {name: [node for node in nodes
                       if node not in (own, own + GUARD) and not node.startswith(QUIET_NODES)]
                for name, nodes in part.items()
                if name not in QUIET_TOPICS and not name.endswith(QUIET_ENDINGS)}
        return {name: nodes for name, nodes in kept.items() if nodes}

    return SystemState(
        filtered(state.publishers), filtered(state.subscribers), filtered(state.services))


def _nodes(state: SystemState) -> list[str]:
    parts = (state.publishers, state.subscribers, state.services)
    return sorted({node for part in parts for nodes in part.values() for node in nodes})


def _edges(flows: list[Flow], view: str) -> dict[tuple[str, str], set[str]]:
    """Edges with their topics: from publisher to subscriber in view `nodes`, else via the topic.

    Edges whose other end is missing are only in the view `all`.
    """
    edges: dict[tuple[str, str], set[str]] = defaultdict(set)
    for source, topic, target in flows:
        if source and target and view == "nodes":
            edges[_node(source), _node(target)].add(topic)
        elif view == "all" or (source and target and view != "nodes"):
            if source:
                edges[_node(source), "t" + topic].add(topic)
            if target:
                edges["t" + topic, _node(target)].add(topic)
    return edges


def _node(name: str) -> str:
    """Nodes and topics may have one name: `n/x` is the node, `t/x` the topic."""
    return "n" + name
