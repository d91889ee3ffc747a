"""Interactive markers: what a server says becomes controls, and what is wrong becomes a status."""

import math

import numpy as np
import pytest
import rospy
from geometry_msgs.msg import Quaternion, Vector3
from interactive_messages import TO_Z, control, cube, handle, init, moved, scene, update
from rviz_messages import at, turned
from rviz_view import MadeUpView, drawer
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays import interactive, interactive_marker
from sim_viewer.rviz.displays.interactive import TYPE, namespace
from sim_viewer.rviz.displays.interactive_marker import unique
from visualization_msgs.msg import InteractiveMarkerControl as Mode
from visualization_msgs.msg import InteractiveMarkerUpdate, Marker

from bullet_sim.pose import IDENTITY, Pose

KEEP_ALIVE = InteractiveMarkerUpdate.KEEP_ALIVE
WAITS = ("warning", "Waiting for all markers, on update_full")
MISSED = ("error", "Update sequence number is out of order.")


def shown(*messages, view=None, **options):
    """A display that got these messages, and its first drawing."""
    made = drawer("InteractiveMarkers", **options)
    for message in messages:
        made.take(message, None, 0.0)
    return made, made.draw(view or MadeUpView())


def names(parts):
    return [one["key"].split("\n")[1] for one in parts[0].fields["markers"]] if parts else []


def owned(parts):
    """Kinds of the parts by marker and control."""
    found = {}
    for part in parts[1:]:
        owner = part.fields["marker"], part.fields["control"]
        found.setdefault(owner, []).append(part.fields.get("shape", part.kind))
    return found


# --- what there is

def test_each_control_has_its_parts_and_the_page_learns_what_it_can_do():
    view = MadeUpView()
    view.places["odom"] = Pose((0.5, 0.0, 0.0))
    made, parts = shown(init(0, *scene()), view=view)
    head = parts[0].fields
    assert names(parts) == ["pushed", "turned", "clicked", "moved", "asked"]
    assert owned(parts) == {(0, 0): ["cylinder", "cone"], (0, 2): ["texts"],
                            (1, 0): ["triangles"], (2, 0): ["cube"], (3, 0): ["cube"],
                            (4, 0): ["texts"]}
    pushed, _, clicked, *_ = head["markers"]
    assert pushed["place"][:3] == [0.5, 0.0, 0.0] and pushed["pose"][:2] == [-0.5, 1.0]
    assert (pushed["controls"][0]["name"], pushed["controls"][0]["mode"]) == (
        "along", Mode.MOVE_AXIS)
    assert clicked["menu"] is True and pushed["menu"] is False
    assert made.find(clicked["key"]).menu() == [
        {"id": 1, "parent": 0, "title": "More", "works": True},
        {"id": 2, "parent": 1, "title": "Home", "works": True},
        {"id": 3, "parent": 0, "title": "Shell", "works": False}]
    assert made.statuses == {"s": ("ok", "OK")}
    assert made.draw(view) is None


def test_the_options_show_axes_and_descriptions():
    message = handle("a", description="words")
    shows = {"Show Axes": True, "Show Descriptions": True, "Show Visual Aids": True}
    _, parts = shown(init(0, message), **shows)
    assert owned(parts) == {(0, 0): ["cylinder"], (0, 1): ["texts"]}
    assert parts[0].fields["visual_aids"] is True
    made, parts = shown(init(0, message), **dict.fromkeys(shows, False))
    assert owned(parts) == {} and names(parts) == ["a"]
    made.restyle({**made.options, "Show Descriptions": True})
    assert owned(made.draw(MadeUpView())) == {(0, 1): ["texts"]}


@pytest.mark.parametrize("mode, kinds", [
    (Mode.NONE, []), (Mode.MENU, ["texts"]), (Mode.BUTTON, []),
    (Mode.MOVE_AXIS, ["cylinder", "cone"]), (Mode.MOVE_PLANE, ["triangles"]),
    (Mode.ROTATE_AXIS, ["triangles"]), (Mode.MOVE_ROTATE, ["triangles"]), (Mode.MOVE_3D, []),
])
def test_controls_without_markers_get_those_of_rviz(mode, kinds):
    _, parts = shown(init(0, handle("a", control(mode, "c", description="menu"))))
    assert owned(parts).get((0, 0), []) == kinds


def test_arrows_point_both_ways_along_the_axis_in_its_colour():
    message = handle("a", control(Mode.MOVE_AXIS, orientation=turned(math.pi / 2)))
    message.scale = 2.0
    _, (_, shafts, heads) = shown(init(0, message))
    middle = shafts.arrays["rows"]
    np.testing.assert_allclose(middle[:, :3], [[0, 1.2, 0], [0, -1.2, 0]], atol=1e-6)
    np.testing.assert_allclose(middle[:, 7:], [[0.3, 0.3, 0.4]] * 2, atol=1e-6)
    np.testing.assert_allclose(heads.arrays["rows"][:, 1], [1.6, -1.6], atol=1e-6)
    assert shafts.arrays["colour"].tolist() == [[0, 255, 0, 128]] * 2


def test_a_ring_stands_across_its_axis():
    _, (_, ring) = shown(init(0, handle("a", control(Mode.ROTATE_AXIS, orientation=TO_Z))))
    radius = np.linalg.norm(ring.arrays["position"], axis=1)
    assert (radius.min(), radius.max()) == pytest.approx((0.5, 0.65))
    assert not ring.arrays["position"][:, 0].any()  # across x, which its pose turns to z
    assert ring.pose.orientation == pytest.approx((0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)))


def test_markers_with_a_frame_of_their_own_stand_there():
    far = cube()
    far.header.frame_id, far.pose = "robot", at(1.0, 0.0)
    view = MadeUpView()
    view.places["robot"] = Pose((3.0, 0.0, 0.0))
    for mode, place in ((Mode.INHERIT, (1.0, -2.0)), (Mode.FIXED, (2.0, 1.0))):
        one = control(Mode.BUTTON, orientation_mode=mode, markers=[far])
        _, (_, part) = shown(init(0, handle("a", one, pose=at(2.0, -1.0, math.pi / 2))), view=view)
        np.testing.assert_allclose(part.arrays["rows"][0, :2], place, atol=1e-6)


def test_meshes_belong_to_their_controls():
    mesh = Marker(type=Marker.MESH_RESOURCE, scale=Vector3(1, 1, 1), mesh_resource="package://a")
    controls = [control(Mode.BUTTON, markers=[mesh]), control(Mode.BUTTON, markers=[cube(), mesh])]
    _, parts = shown(init(0, handle("a", *controls)))
    assert owned(parts) == {(0, 0): ["links"], (0, 1): ["cube", "links"]}
    assert [part.fields["links"] for part in parts if part.kind == "links"] == [
        ["0/0/0"], ["0/1/1"]]


def test_names_of_controls_are_made_unique_as_rviz_does():
    assert unique(["a", "b", "a", "a", ""]) == ["a", "b", "a_u0", "a_u1", ""]


def test_topics_stand_beside_that_of_updates():
    assert TYPE.beside_topic("/a/b/update") == "/a/b/update_full"
    assert namespace("/a/b/update") == "/a/b"


# --- what changes

def test_changes_are_followed_in_their_order():
    view = MadeUpView()
    made, parts = shown(update(1, [handle("early")]), view=view)
    assert not parts and made.statuses["s"] == WAITS
    made.take(init(1, handle("a"), handle("b")), None, 0.0)
    assert names(made.draw(view)) == ["a", "b"]
    made.take(update(2, [handle("c")], [moved("b", at(5.0, 0.0))], ["a"]), None, 0.0)
    parts = made.draw(view)
    assert names(parts) == ["b", "c"] and parts[0].fields["markers"][0]["pose"][0] == 5.0
    for again in (init(2, handle("b"), handle("c")), update(2, [], [], ["b"]),
                  update(2, kind=KEEP_ALIVE)):
        made.take(again, None, 0.0)
        assert made.draw(view) is None and made.statuses["s"] == ("ok", "OK")


def test_missed_changes_come_with_all_the_others():
    made, _ = shown(init(1, handle("a")))
    made.take(update(3, [handle("b")]), None, 0.0)
    assert made.draw(MadeUpView()) is None and made.statuses["s"] == MISSED
    made.take(init(3, handle("b"), handle("c")), None, 0.0)
    assert names(made.draw(MadeUpView())) == ["b", "c"] and made.statuses["s"] == ("ok", "OK")
    made.take(update(9, kind=KEEP_ALIVE), None, 0.0)
    made.draw(MadeUpView())
    assert made.statuses["s"] == MISSED


def test_a_server_that_begins_anew_shows_what_it_has_now():
    made, _ = shown(init(1, handle("a")))
    made.take(init(1, handle("b")), None, 0.0)  # as many changes as before
    assert names(made.draw(MadeUpView())) == ["b"]


def test_servers_of_one_topic_keep_their_own_markers_and_silence_is_told_of():
    view = MadeUpView()
    made, parts = shown(init(0, handle("a")), init(7, handle("a"), server="other"), view=view)
    assert [one["key"] for one in parts[0].fields["markers"]] == ["s\na", "other\na"]
    view.wall = 3.4
    made.take(update(7, kind=KEEP_ALIVE, server="other"), None, 0.0)
    assert made.draw(view) is None
    assert made.statuses == {"s": ("warning", "No update received for 3 seconds."),
                             "other": ("ok", "OK")}


def test_a_marker_without_a_stamp_goes_with_its_frame():
    view = MadeUpView()
    view.places["robot"] = IDENTITY
    still = handle("still", frame="robot")
    still.header.stamp = rospy.Time(1)
    made, _ = shown(init(0, handle("goes", frame="robot"), still), view=view)
    view.places["robot"] = Pose((2.0, 0.0, 0.0))
    assert [one["place"][0] for one in made.draw(view)[0].fields["markers"]] == [2.0, 0.0]
    assert made.place_anew()
    assert [one["place"][0] for one in made.draw(view)[0].fields["markers"]] == [2.0, 2.0]


def test_the_page_moves_a_marker_until_its_server_does():
    made, _ = shown(init(0, handle("a")))
    made.drag("s\na", Pose((1.0, 0.0, 0.0)))
    made.drag("s\ngone", IDENTITY)
    assert made.draw(MadeUpView())[0].fields["markers"][0]["pose"][0] == 1.0
    made.drag("s\na", Pose((2.0, 0.0, 0.0)))  # which is answered before the next look
    made.take(update(1, poses=[moved("a", at(0.5, 0.0))]), None, 0.0)
    assert made.draw(MadeUpView())[0].fields["markers"][0]["pose"][0] == 0.5


# --- what is wrong

def broken(**fields):
    made = handle("bad", control(Mode.MOVE_AXIS, "c"))
    for name, value in fields.items():
        setattr(made, name, value)
    return made


@pytest.mark.parametrize("message, said", [
    (broken(pose=at(math.nan, 0.0)), "nans or infs"), (broken(scale=math.inf), "nans or infs"),
    (broken(scale=-1.0), "not between 0"), (broken(pose=at(1e9, 0.0)), "farther than"),
    (handle("bad", control(77, "c")), "c: Unknown interaction mode: 77"),
    (handle("bad", control(Mode.NONE, "c", orientation_mode=9)), "c: Unknown orientation mode: 9"),
    (handle("bad", control(Mode.NONE, orientation=Quaternion(math.nan, 0, 0, 1))), "nans or infs"),
    (handle("bad", control(Mode.BUTTON, "c", markers=[Marker(type=99)])), "Unknown marker type"),
    (handle("bad", control(Mode.BUTTON, markers=[cube(pose=at(math.inf, 0))])), "nans or infs"),
    (handle("bad", frame="moon"), "Frame [moon] does not exist"),
    (handle("bad", control(Mode.BUTTON, markers=[
        Marker(type=Marker.CUBE, header=handle("", frame="moon").header)])), "Frame [moon] does"),
    (handle("bad", *[control(Mode.NONE)] * 101), "showing 100 of 101 controls"),
])
def test_a_broken_marker_is_told_of_and_the_others_are_shown(message, said):
    made, parts = shown(init(0, message, handle("good", control(Mode.MOVE_AXIS))))
    level, text = made.statuses["bad"]
    assert level == "error" and said in text
    assert "good" in names(parts) and ["cylinder", "cone"] in owned(parts).values()


def test_a_pose_that_is_none_is_told_of_and_the_others_are_followed():
    made, _ = shown(init(0, handle("a"), handle("b")))
    with pytest.raises(Problem, match="a: Message contained invalid"):
        made.take(update(1, [handle("c", pose=at(5.0, 0.0))], [
            moved("a", at(math.nan, 0)), moved("b", at(3.0, 0.0))]), None, 0.0)
    poses = [one["pose"][0] for one in made.draw(MadeUpView())[0].fields["markers"]]
    assert poses == [0.0, 3.0, 5.0]


def test_orientations_of_any_length_are_taken():
    for tiny_or_large in (1e-200, 1.0, 1e200):
        unit = interactive_marker.unit(Quaternion(0.0, 0.0, tiny_or_large, tiny_or_large))
        assert unit == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert interactive_marker.unit(Quaternion(0.0, 0.0, 0.0, 0.0)) == (0.0, 0.0, 0.0, 1.0)


def test_more_than_a_page_can_draw_is_left_out_and_told_of(monkeypatch):
    monkeypatch.setattr(interactive, "MOST_CONTROLS", 3)
    many = [handle(name, control(Mode.NONE), control(Mode.NONE)) for name in "abc"]
    made, parts = shown(init(0, *many))
    assert names(parts) == ["a"]
    assert made.statuses["Markers"] == ("warning", "showing 1 of 3 markers")
    monkeypatch.setattr(interactive, "MOST_CONTROLS", 100)
    monkeypatch.setattr(interactive, "MOST_SHAPES", 5)
    large = [handle(name, control(Mode.BUTTON, markers=[cube()] * 3)) for name in "abc"]
    assert names(shown(init(0, *large))[1]) == ["a"]


def test_more_than_there_is_room_for_is_refused(monkeypatch):
    monkeypatch.setattr(interactive, "MOST_MARKERS", 2)
    made = drawer("InteractiveMarkers")
    with pytest.raises(Problem, match="showing 2 markers"):
        made.take(init(0, *map(handle, "abc")), None, 0.0)
    assert names(made.draw(MadeUpView())) == ["a", "b"]
    with pytest.raises(Problem, match="longer than 200"):
        made.take(init(1, handle("a"), handle("x" * 201), handle("b")), None, 0.0)
    assert names(made.draw(MadeUpView())) == ["a", "b"]
    with pytest.raises(Problem, match="showing 2 markers"):
        made.take(update(2, [handle("c"), handle("b", pose=at(5.0, 0.0))]), None, 0.0)
    assert made.find("s\nb").message.pose.position.x == 5.0
    with pytest.raises(Problem, match="longer than 200"):
        made.take(init(1, server="x" * 201), None, 0.0)
    monkeypatch.setattr(interactive, "MOST_SERVERS", 1)
    made.take(init(0, handle("d"), server="other"), None, 0.0)
    made.draw(MadeUpView())
    assert made.statuses["Servers"] == ("warning", "showing 1: more are left out")
