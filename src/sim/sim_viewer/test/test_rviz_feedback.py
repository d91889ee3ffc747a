"""What a page may say of interactive markers, and what their server hears of it."""

import asyncio
import math
from types import SimpleNamespace

import pytest
from interactive_messages import EVENTS, control, handle, init
from rviz_messages import at
from rviz_view import MadeUpView, drawer
from sim_viewer.options import Options
from sim_viewer.registry import Context, Node, Refused, find_operation
from sim_viewer.rviz.display import Displays
from sim_viewer.rviz.tools import Publishers, rviz_feedback, rviz_menu
from visualization_msgs.msg import InteractiveMarkerControl as Mode
from visualization_msgs.msg import MenuEntry

KEY = "s\na"
HONEST = {"display": 1, "marker": KEY, "control": "c", "event": "POSE_UPDATE",
          "pose": [1, 2.0, 0, 0, 0, 2.0, 2.0], "point": [1, 1, 1]}


@pytest.fixture
def context():
    loop = asyncio.new_event_loop()
    node = Node(Options(control=True), loop)
    yield Context(node, 1)
    node.close()
    loop.close()


@pytest.fixture
def shown(context):
    """A display of one marker that the page looks at, and one of a grid."""
    made = drawer("InteractiveMarkers")
    made.take(init(0, handle("a", control(Mode.MOVE_AXIS, "c"), pose=at(1.0, 0.0),
                             menu_entries=[MenuEntry(id=7, title="Go")])), None, 0.0)
    made.draw(MadeUpView())
    displays = context.node.shared(Displays)
    displays[1, 1] = SimpleNamespace(drawer=made, topic="/a/update", look_soon=lambda: None)
    displays[1, 2] = SimpleNamespace(drawer=drawer("Grid"))
    return made


@pytest.fixture
def sent(context, monkeypatch):
    """Topics and messages that are published."""
    found = []
    monkeypatch.setattr(Publishers, "open_topic", lambda self, use, topic, kind: SimpleNamespace(
        publish=lambda message: found.append((topic, message))))
    return found


def say(context, **changes):
    context.loop.run_until_complete(rviz_feedback(context, **HONEST | changes))


def test_a_drag_moves_the_marker_and_its_server_hears_of_it(context, shown, sent):
    say(context)
    ((topic, message),) = sent
    assert topic == "/a/feedback" and EVENTS[message.event_type] == "POSE_UPDATE"
    assert (message.marker_name, message.control_name) == ("a", "c")
    assert message.header.frame_id == "map" and message.client_id.endswith("/1/1")
    assert (message.pose.position.y, message.pose.orientation.w) == (2.0, pytest.approx(0.5 ** 0.5))
    assert message.mouse_point_valid and message.mouse_point.z == 1.0
    assert shown.draw(MadeUpView())[0].fields["markers"][0]["pose"][:2] == [1.0, 2.0]


def test_an_entry_of_a_menu_is_told_of_without_a_move(context, shown, sent):
    assert context.loop.run_until_complete(rviz_menu(context, 1, KEY)) == [
        {"id": 7, "parent": 0, "title": "Go", "works": True}]
    say(context, event="MENU_SELECT", entry=7, point=[])
    ((_, message),) = sent
    assert message.menu_entry_id == 7 and not message.mouse_point_valid
    assert shown.draw(MadeUpView()) is None


def test_a_marker_that_came_anew_is_told_of_before_it_is_drawn(context, shown, sent):
    button = control(Mode.BUTTON, "c")
    shown.take(init(1, handle("a", button, button)), None, 0.0)
    for name in ("c", "c_u0", ""):
        say(context, control=name)
    assert [message.control_name for _, message in sent] == ["c", "c_u0", ""]


@pytest.mark.parametrize("changes, said", [
    ({"display": 3}, "no such one"), ({"display": 2}, "shows no interactive markers"),
    ({"marker": "s\nb"}, "no marker"), ({"marker": "a"}, "no marker"),
    ({"control": "b"}, "no control"), ({"event": "EXPLODE"}, "no event 'EXPLODE'"),
    ({"entry": -1}, "no menu has"), ({"entry": 2 ** 40}, "no menu has"),
    ({"pose": [0] * 6}, "not 7 numbers"), ({"pose": ["0"] * 7}, "not 7 numbers"),
    ({"pose": [True] * 7}, "not 7 numbers"), ({"pose": [math.nan] * 7}, "not 7 numbers"),
    ({"pose": [10 ** 400] * 7}, "not 7 numbers"), ({"point": [1]}, "not 3 numbers"),
    ({"point": [1, 2, math.inf]}, "not 3 numbers"),
])
def test_what_does_not_fit_is_refused_and_not_sent(context, shown, sent, changes, said):
    with pytest.raises(Refused, match=said):
        say(context, **changes)
    assert not sent and shown.draw(MadeUpView()) is None


def test_a_page_without_control_may_not_ask():
    assert find_operation("rviz_feedback").control and find_operation("rviz_menu").control
