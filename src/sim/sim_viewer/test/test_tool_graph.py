"""What of the master's state is drawn."""

import pytest
from sim_viewer.registry import Refused
from sim_viewer.tools.graph import draw
from sim_viewer.tools.master import SystemState

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
