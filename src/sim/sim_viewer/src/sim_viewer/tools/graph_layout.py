"""Places for a directed graph's nodes and curves for its edges, by Graphviz."""

import shlex
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass

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
