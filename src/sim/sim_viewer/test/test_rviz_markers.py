"""Markers of every type, how they change and end, and what is wrong with some."""

import math

import pytest
from geometry_msgs.msg import Point, Vector3
from rviz_messages import (
    at,
    markers,
)
from rviz_view import MadeUpView, draw, drawer, only
from sim_viewer.rviz.display_type import ERROR
from sim_viewer.rviz.displays import markers as module
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from bullet_sim.pose import Pose


def test_every_type_of_marker_has_its_parts():
    parts, statuses = draw("MarkerArray", markers(), None)
    count = {}
    for part in parts:
        name = part.fields.get("shape", part.kind)
        count[name] = count.get(name, 0) + len(part.arrays.get("rows", [0]))
    assert count == {"cylinder": 2, "cone": 1, "cube": 5, "sphere": 5, "lines": 2, "points": 1,
                     "texts": 1, "triangles": 1, "links": 1}
    assert not statuses


def marker(**fields):
    made = Marker(type=Marker.CUBE, ns="a", pose=at(0, 0), scale=Vector3(1, 1, 1),
                  color=ColorRGBA(1, 0, 0, 1), **fields)
    made.header.frame_id = "map"
    return made


def cubes(made, view):
    parts = made.draw(view)
    return None if parts is None else sum(len(part.arrays["rows"]) for part in parts)


def test_markers_are_changed_deleted_and_gone_after_their_lifetime():
    made, view = drawer("Marker"), MadeUpView()
    for number in range(4):
        made.take(marker(id=number), None, 0.0)
    made.take(marker(id=1), None, 0.0)  # the same again
    assert cubes(made, view) == 4 and cubes(made, view) is None
    made.take(marker(id=2, action=Marker.DELETE), None, 0.0)
    assert cubes(made, view) == 3
    brief = marker(id=9)
    brief.lifetime.secs = 2
    made.take(brief, None, 10.0)
    view.now = 11.0
    assert cubes(made, view) == 4
    view.now = 12.0
    assert cubes(made, view) == 3
    made.take(marker(action=Marker.DELETEALL), None, 0.0)
    assert cubes(made, view) == 0


def test_markers_with_a_lifetime_are_gone_when_time_begins_anew():
    made, view = drawer("Marker"), MadeUpView()
    view.now = 1000.0
    brief = marker(id=1)
    brief.lifetime.secs = 2
    for one in (marker(id=0), brief):
        made.take(one, None, view.now)
    assert cubes(made, view) == 2
    view.now = 0.5
    assert cubes(made, view) == 1


def test_more_markers_than_are_shown_are_told_of(monkeypatch):
    monkeypatch.setattr(module, "MOST_MARKERS", 2)
    made, view = drawer("Marker"), MadeUpView()
    for number in range(3):
        made.take(marker(id=number), None, 0.0)
    assert cubes(made, view) == 2
    assert made.statuses["Markers"] == ("warning", "showing 2: more are left out")


def test_a_marker_stays_where_its_frame_was_unless_it_is_locked_to_it():
    made, view = drawer("Marker"), MadeUpView()
    view.places["robot"] = Pose((1.0, 0.0, 0.0))
    for number, locked in enumerate((False, True)):
        one = marker(id=number, frame_locked=locked)
        one.header.frame_id = "robot"
        made.take(one, None, 0.0)
    made.draw(view)
    view.places["robot"] = Pose((5.0, 0.0, 0.0))
    assert only(made.draw(view)).arrays["rows"][:, 0].tolist() == [1.0, 5.0]


def test_hidden_namespaces_are_not_drawn():
    made = drawer("Marker", Namespaces={"a": False})
    made.take(marker(), None, 0.0)
    assert cubes(made, MadeUpView()) == 0 and made.namespaces == ["a"]
    made.restyle({"Namespaces": {"a": True}})
    assert cubes(made, MadeUpView()) == 1


@pytest.mark.parametrize("fields, said", [
    ({"scale": Vector3(0, 1, 1)}, "Scale contains 0.0"),
    ({"scale": Vector3(math.nan, 1, 1)}, "nans or infs"),
    ({"type": 77}, "Unknown marker type: 77"), ({"type": Marker.POINTS}, "Points should not be"),
    ({"type": Marker.LINE_LIST, "points": [Point()]}, "multiple of 2"),
    ({"type": Marker.ARROW, "points": [Point()]}, "either 0 or 2"),
    ({"type": Marker.TEXT_VIEW_FACING, "text": " "}, "Text is empty"),
    ({"type": Marker.MESH_RESOURCE, "mesh_resource": "package://none/a.stl"}, "Could not load"),
    ({"type": Marker.LINE_STRIP, "points": [Point(math.inf, 0, 0)] * 2}, "nans or infs"),
])
def test_a_broken_marker_is_told_of_and_the_others_are_shown(fields, said):
    made, view = drawer("Marker"), MadeUpView()
    broken = marker(id=1)
    for name, value in fields.items():
        setattr(broken, name, value)
    made.take(marker(id=0), None, 0.0)
    made.take(broken, None, 0.0)
    made.draw(view)
    level, text = made.statuses["a/1"]
    assert level == ERROR and said in text
    made.take(marker(id=1), None, 0.0)
    assert cubes(made, view) == 2 and not made.statuses
