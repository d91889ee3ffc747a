"""The page's graph of nodes: what is in it, and where each stands."""

import itertools
import math
import os
import random
import subprocess

import pytest
from sim_viewer.registry import Refused
from sim_viewer.tools import graph
from sim_viewer.tools.graph import LayoutError, draw, layout
from sim_viewer.tools.master import SystemState


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


STATE = SystemState(
    publishers={"/cmd_vel": ["/follower"], "/camera/image": ["/gazebo"], "/clock": ["/gazebo"],
                "/rosout": ["/follower", "/gazebo"], "/lonely": ["/gazebo"]},
    subscribers={"/cmd_vel": ["/gazebo"], "/camera/image": ["/follower", "/sim_viewer"],
                 "/clock": ["/follower"], "/rosout": ["/rosout"]},
    services={"/gazebo/reset_world": ["/gazebo"], "/idle/get_loggers": ["/idle"]},
)


def edges(picture):
    return {(edge["from"], edge["to"]) for edge in picture["edges"]}


def names(picture):
    return {node["name"] for node in picture["nodes"]}


def test_topics_stand_between_nodes():
    picture = draw(STATE, "active", quiet=True, own="/sim_viewer")
    assert edges(picture) == {
        ("n/follower", "t/cmd_vel"), ("t/cmd_vel", "n/gazebo"),
        ("n/gazebo", "t/camera/image"), ("t/camera/image", "n/follower")}
    assert "/idle" in names(picture)  # a node without topics is there all the same
    assert {node["name"] for node in picture["nodes"] if node["topic"]} == {
        "/cmd_vel", "/camera/image"}


def test_nodes_only_has_the_topics_on_the_arrows():
    picture = draw(STATE, "nodes", quiet=True, own="/sim_viewer")
    assert {(e["from"], e["to"], *e["topics"]) for e in picture["edges"]} == {
        ("n/follower", "n/gazebo", "/cmd_vel"), ("n/gazebo", "n/follower", "/camera/image")}


def test_all_topics_include_those_with_one_side():
    assert ("n/gazebo", "t/lonely") in edges(draw(STATE, "all", quiet=True, own="/sim_viewer"))


def test_quiet_hides_the_log_the_clock_and_this_page():
    everything = draw(STATE, "active", quiet=False, own="/sim_viewer")
    assert {"/rosout", "/clock", "/sim_viewer"} <= names(everything)
    quiet = draw(STATE, "all", quiet=True, own="/sim_viewer")
    assert not {"/rosout", "/clock", "/sim_viewer"} & names(quiet)


def test_a_text_keeps_what_has_it_in_a_name():
    picture = draw(STATE, "active", quiet=True, text="cmd", own="/sim_viewer")
    assert names(picture) == {"/follower", "/cmd_vel", "/gazebo"}


def test_every_arrow_begins_and_ends_at_its_nodes():
    picture = draw(STATE, "all")
    box = {node["id"]: node["box"] for node in picture["nodes"]}
    for edge in picture["edges"]:
        for end, (x, y) in ((edge["from"], edge["curve"][0]), (edge["to"], edge["curve"][-1])):
            middle_x, middle_y, width, height = box[end]
            assert abs(x - middle_x) <= width / 2 + 1 and abs(y - middle_y) <= height / 2 + 1


def test_too_many_arrows_ask_for_a_filter():
    crowd = [f"/n{i}" for i in range(40)]
    state = SystemState({"/t": crowd}, {"/t": [name + "x" for name in crowd]}, {})
    assert len(draw(state, "active")["edges"]) == 80
    with pytest.raises(Refused, match=r"1600 arrows.*filter"):
        draw(state, "nodes")
