"""The graph's layout: from left to right, nothing on top of anything, and always an end."""

import itertools
import math
import os
import random
import subprocess

import pytest
from sim_viewer.tools import graph
from sim_viewer.tools.graph import LayoutError, layout


def named(nodes) -> dict[str, str]:
    return {node: node for node in nodes}


def test_what_is_fed_stands_to_the_right():
    plan = layout(named("abc"), [("a", "b"), ("b", "c"), ("a", "c")])
    assert plan.boxes["a"][0] < plan.boxes["b"][0] < plan.boxes["c"][0] < plan.size[0]


def test_boxes_do_not_overlap_and_lie_within_the_picture():
    names = {str(i): f"/a/name/that/is/long/{i}" for i in range(20)}
    plan = layout(names, [(str(i), str(j)) for i in range(10) for j in range(10, 20, i % 3 + 1)])
    for (x, y, width, height), (u, v, wide, high) in itertools.combinations(
            plan.boxes.values(), 2):
        assert abs(x - u) >= (width + wide) / 2 or abs(y - v) >= (height + high) / 2
    for x, y, width, height in plan.boxes.values():
        assert width / 2 <= x <= plan.size[0] - width / 2
        assert height / 2 <= y <= plan.size[1] - height / 2


def test_circles_loops_and_nodes_alone_have_their_place():
    plan = layout(named("abcd"), [("a", "b"), ("b", "a"), ("c", "c")])
    assert set(plan.boxes) == set("abcd")
    assert all(len(curve) % 3 == 1 for curve in plan.curves.values())
    assert set(plan.curves) == {("a", "b"), ("b", "a"), ("c", "c")}
    assert layout({}, []).boxes == {}


def test_names_may_hold_anything():
    names = {"q": 'a "quoted" \\n name', "e": "", "x": "-> ; }",
             "n": "two\nlines", "u": "a\u2028b\x85c\0d", "s": "it's"}
    assert set(layout(names, [("q", "e"), ("e", "x"), ("n", "u")]).boxes) == set(names)


def test_the_same_graph_has_the_same_layout_whatever_the_order():
    edges = [("a", "b"), ("a", "c"), ("b", "d"), ("c", "d")]
    assert layout(named("abcd"), edges) == layout(named("dcba"), edges[::-1])


def test_a_large_graph_has_straight_edges_in_time():
    pick = random.Random(1)
    nodes, topics = [f"n{i}" for i in range(200)], [f"t{i}" for i in range(200)]
    edges = {(pick.choice(nodes), topic) for topic in topics}
    edges |= {(topic, pick.choice(nodes)) for topic in topics}
    plan = layout(named(nodes + topics), edges)
    assert set(plan.curves) == edges and len(edges) > graph.MOST_CURVED
    for (x, y), *between, (u, v) in plan.curves.values():
        for s, t in between:
            assert abs((s - x) * (v - y) - (t - y) * (u - x)) / math.dist((x, y), (u, v)) < 1.0


def test_without_dot_it_says_what_to_type(monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(LayoutError, match="apt-get install graphviz"):
        layout(named("a"), [])


def test_a_graph_that_takes_too_long_to_layer_is_laid_out_by_springs(monkeypatch):
    run = subprocess.run

    def layers_take_long(*arguments, **options):
        if "sfdp" not in options["input"]:
            raise subprocess.TimeoutExpired("dot", 5.0)
        return run(*arguments, **options)

    monkeypatch.setattr(graph.subprocess, "run", layers_take_long)
    names = {str(i): f"/node/{i}" for i in range(40)}
    plan = layout(names, [(str(i), str(i * 7 % 40)) for i in range(40)])
    assert set(plan.boxes) == set(names)
    for (x, y, width, height), (u, v, wide, high) in itertools.combinations(
            plan.boxes.values(), 2):
        assert abs(x - u) >= (width + wide) / 2 - 1 or abs(y - v) >= (height + high) / 2 - 1


def test_a_graph_that_takes_too_long_is_refused(monkeypatch):
    monkeypatch.setattr(graph, "LONGEST", 0.05)
    pick = random.Random(1)
    nodes = [str(i) for i in range(300)]
    edges = [(pick.choice(nodes), pick.choice(nodes)) for _ in range(3000)]
    start = sum(os.times()[:4])  # s of a processor, also dot's
    with pytest.raises(LayoutError, match="filter by part of a name"):
        layout(named(nodes), edges)
    assert sum(os.times()[:4]) - start < 5.0


def test_what_dot_says_when_it_fails_is_passed_on(monkeypatch):
    def fail(*_args, **_options):
        raise subprocess.CalledProcessError(1, "dot", stderr="Error: out of ink\n")

    monkeypatch.setattr(graph.subprocess, "run", fail)
    with pytest.raises(LayoutError, match="dot failed: Error: out of ink"):
        layout(named("a"), [])
