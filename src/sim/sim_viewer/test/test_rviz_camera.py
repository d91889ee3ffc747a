"""A camera's picture and the scene over it: what the page is sent, and what is missing is said."""

import math

import pytest
from rviz_messages import camera_info, view_from_above
from rviz_view import MadeUpView, drawer, only
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays.camera import info_topic, intrinsics_of
from sim_viewer.rviz.options import check_all
from sim_viewer.rviz.showing import Showing
from sim_viewer.rviz.types import TYPES

from bullet_sim.pose import IDENTITY, Pose

ABOVE = Pose((0.0, 0.0, 2.0))


def test_a_picture_has_its_pose_and_the_camera_s_intrinsics():
    made = drawer("Camera", **{"Overlay Alpha": 0.3, "Image Rendering": "overlay"})
    made.take(camera_info(), None, 0.0)
    made.take(view_from_above(), ABOVE, 0.0)
    part = only(made.draw(MadeUpView()))
    assert part.kind == "camera" and part.pose == ABOVE
    assert part.arrays["jpeg"].tobytes() == view_from_above().data
    assert part.fields == {
        "size": (64, 48), "focal_length": (32.0, 32.0), "principal_point": (16.0, 24.0),
        "shift": (-0.0, -0.0), "rendering": "overlay", "alpha": 0.3, "zoom": 1.0}
    assert made.draw(MadeUpView()) is None  # nothing is new
    made.take(camera_info(), None, 0.0)
    assert made.draw(MadeUpView()) is None


def test_a_picture_waits_for_its_camera_info():
    made = drawer("Camera")
    made.take(view_from_above(), IDENTITY, 0.0)
    assert made.draw(MadeUpView()) == []
    assert made.statuses["Camera Info"] == ("warning", "No CameraInfo received")
    made.take(camera_info(), None, 0.0)
    assert only(made.draw(MadeUpView())) and made.statuses["Camera Info"] == ("ok", "OK")


def test_the_right_camera_of_a_pair_stands_beside_the_left_one():
    info = camera_info()
    info.P[3] = -32.0 * 0.12  # -fx times the distance, as image_proc's page has it
    assert intrinsics_of(info)[0].shift == pytest.approx((0.12, 0.0))


@pytest.mark.parametrize("change, said", [
    ({"width": 0}, "not calibrated"), ({"P": [0.0] * 12}, "not calibrated"),
    ({"P": [1e-320] * 12}, "not calibrated"), ({"height": 200_000}, "not calibrated"),
    ({"P": [math.nan] * 12}, "nans or infs")])
def test_a_camera_info_of_no_use_is_an_error(change, said):
    info = camera_info()
    for name, value in change.items():
        setattr(info, name, value)
    found, (level, text) = intrinsics_of(info)
    assert found is None and level == "error" and said in text


def test_a_picture_that_cannot_be_shown_is_said():
    made = drawer("Camera")
    empty = view_from_above()
    empty.data = b""
    made.take(empty, IDENTITY, 0.0)
    with pytest.raises(Problem, match="no pixels"):
        made.draw(MadeUpView())


@pytest.mark.parametrize("picture, info", [
    ("/camera/image_raw", "/camera/camera_info"), ("image", "/camera_info"),
    ("/camera/rgb/image_raw/compressed", "/camera/rgb/camera_info")])
def test_the_camera_info_is_beside_the_picture(picture, info):
    assert info_topic(picture) == info


class Raw:
    def __init__(self, message):
        self.message, self._buff = message, b""


def test_a_camera_info_is_known_whenever_it_comes():
    kind, view = TYPES["rviz/Camera"], MadeUpView()
    view.places["eye"] = ABOVE
    shown = Showing(kind, check_all(kind.options, {}), view,
                    lambda raw: (raw.message, "/camera_node"))
    shown.put(Raw(camera_info()), beside=True)
    assert not shown.look()
    shown.put(Raw(view_from_above()))
    assert only(shown.look()).pose == ABOVE
    view.places["map"], view.fixed_frame = IDENTITY, "map"
    shown.change(check_all(kind.options, {"Zoom Factor": 2.0}), "map")
    assert only(shown.look()).fields["zoom"] == 2.0
    shown.change(check_all(kind.options, {}), "eye")  # another fixed frame: placed anew
    assert only(shown.look()).pose == ABOVE
