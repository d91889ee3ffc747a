"""The graph of nodes and topics, as in rqt_graph; Graphviz says where nodes and edges are."""

import shlex
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import rospy

from sim_viewer.drive import GUARD
from sim_viewer.registry import Refused, argument, watchable
from sim_viewer.tools.master import SystemState
from sim_viewer.tools.paced import Paced

Edge = tuple[str, str]
Point = tuple[float, float]  # px, from the left and from the top

PX_PER_INCH = 72.0  # of dot's output; its font sizes are in 1/72 inch
STYLE = """rankdir=LR; ranksep=0.9; nodesep=0.2; pad=0.22;
node [shape=box, height=0.39, fontname=Helvetica, fontsize=13, margin="0.19,0"];
edge [dir=none];"""
# The limits bound dot's search for short edges and few crossings: large graphs look no worse.
SEARCH = "nslimit=2; nslimit1=2; mclimit=0.5;"
MOST_CURVED = 300  # edges; with more, curves around the nodes take most of dot's time
FAST_SEARCH = "nslimit=0.3; nslimit1=0.3; mclimit=0.1; splines=line;"
BY_SPRINGS = "layout=sfdp; overlap=prism; splines=line;"  # not layered: 1 s for 1500 edges
LONGEST = 5.0  # s for each way of laying out
VIEWS = ("nodes", "active", "all")  # rqt_graph's Nodes only, Nodes/Topics (active), (all)
QUIET_TOPICS = frozenset(["/rosout", "/rosout_agg", "/clock", "/statistics"])
QUIET_ENDINGS = ("/parameter_descriptions", "/parameter_updates", "/bond")
QUIET_NODES = ("/rosout", "/rqt_", "/rviz", "/rostopic_")
MOST_EDGES = 1500

Flow = tuple[str, str, str]  # "" for a missing end: publisher, topic, subscriber


class LayoutError(Exception):
    """dot is missing, took too long or failed; the text says what to do."""


@dataclass(frozen=True)
class Layout:
    """Sizes and places in px; `curves` are cubic Bezier: a point, then three for each segment."""

    size: Point
    boxes: dict[str, tuple[float, float, float, float]]  # centre x and y, width, height
    curves: dict[Edge, list[Point]]


def layout(names: dict[str, str], edges: Iterable[Edge]) -> Layout:
    """A layout in layers from left to right; `names` are the labels of the nodes.

    With more than MOST_CURVED edges all are straight, and may cross nodes; a graph that cannot be
    layered within LONGEST is laid out by springs. The same graph gives the same layout.
    LayoutError if that fails, too.
    """
    nodes = sorted(names)
    number = {node: str(index) for index, node in enumerate(nodes)}
    lines = [f"{number[node]} [label={_quoted(names[node])}];" for node in nodes]
    pairs = sorted(set(edges))
    lines += [f"{number[source]} -> {number[target]};" for source, target in pairs]
    graph = STYLE + "\n" + "\n".join(lines)
    search = SEARCH if len(pairs) <= MOST_CURVED else FAST_SEARCH
    for way in (search, BY_SPRINGS):
        try:
            return _parsed(_dot(f"digraph {{ {way} {graph} }}"), nodes)
        except subprocess.TimeoutExpired:
            continue
    raise LayoutError("the graph takes too long to lay out; filter by part of a name")


def _quoted(text: str) -> str:
    # dot's output has a line per node: characters that end a line or a C string become spaces.
    text = "".join(each if each.isprintable() else " " for each in text)
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _dot(source: str) -> str:
    try:
        done = subprocess.run(["dot", "-Tplain"], input=source, capture_output=True, text=True,
                              timeout=LONGEST, check=True)
    except FileNotFoundError:
        raise LayoutError("there is no command dot; type: sudo apt-get install graphviz") from None
    except subprocess.CalledProcessError as error:
        raise LayoutError(f"dot failed: {error.stderr.strip()[:200]}") from None
    return done.stdout


def _parsed(plain: str, nodes: list[str]) -> Layout:
    """dot's `plain` format: a line for the graph, each node and each edge; y points up."""
    size, boxes, curves = (0.0, 0.0), {}, {}
    for line in plain.splitlines():
        kind, *words = shlex.split(line)
        if kind == "graph":
            size = (_px(words[1]), _px(words[2]))
        elif kind == "node":
            x, y, width, height = map(_px, words[1:5])
            boxes[nodes[int(words[0])]] = (x, round(size[1] - y, 1), width, height)
        elif kind == "edge":
            values = list(map(_px, words[3:3 + 2 * int(words[2])]))
            curves[nodes[int(words[0])], nodes[int(words[1])]] = [
                (x, round(size[1] - y, 1)) for x, y in zip(values[::2], values[1::2])]
    return Layout(size, boxes, curves)


def _px(inches: str) -> float:
    return round(float(inches) * PX_PER_INCH, 1)


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
        state = without_quiet(state, own)
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


def without_quiet(state: SystemState, own: str,
                  quiet: tuple[str, ...] = QUIET_NODES) -> SystemState:
    """The state without this page's nodes, those that begin as `quiet`, and usual topics."""
    def filtered(part: dict[str, list[str]]) -> dict[str, list[str]]:
        kept = {name: [node for node in nodes
                       if node not in (own, own + GUARD) and not node.startswith(quiet)]
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
