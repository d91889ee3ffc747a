"""What paths, poses, frames and robots are drawn as, and what is broken is refused."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point, PointStamped, Quaternion
from nav_msgs.msg import Odometry
from rviz_messages import at, estimate, footprint, particles, path, sonar
from rviz_view import MadeUpView, draw, drawer, only
from sim_viewer.rviz.display_type import Problem
from sim_viewer.rviz.displays import poses

from bullet_sim.pose import IDENTITY, Pose


def test_a_path_is_a_line_of_its_places():
    part = only(draw("Path", path(), **{"Line Style": "Billboards", "Line Width": 0.04})[0])
    assert part.arrays["position"].shape == (2 * 49, 3) and part.fields["width"] == 0.04
    assert part.arrays["position"][0] == pytest.approx([1.0, 0.5, 0.0])
    assert part.arrays["position"][1] == pytest.approx(part.arrays["position"][2])
    arrows, _ = draw("Path", path(), **{"Pose Style": "Arrows"})
    assert [one.fields.get("shape") for one in arrows] == [None, "cylinder", "cone"]
    empty = path()
    empty.poses = []
    assert only(draw("Path", empty)[0]).arrays["position"].shape == (0, 3)


def test_a_polygon_is_closed():
    positions = only(draw("Polygon", footprint())[0]).arrays["position"]
    assert positions.shape == (8, 3) and positions[-1].tolist() == positions[0].tolist()


def test_arrows_lie_along_the_poses():
    shaft, head = draw("PoseArray", particles(), Shape="Arrow (3D)")[0]
    assert shaft.arrays["rows"].shape == (40, 10) == head.arrays["rows"].shape
    message = particles()
    message.poses = [at(1.0, 2.0, math.pi / 2)]
    shaft, head = draw("PoseArray", message, Shape="Arrow (3D)")[0]
    assert shaft.arrays["rows"][0, :3] == pytest.approx([1.0, 2.0 + 0.23 / 2, 0.0], abs=1e-6)
    assert head.arrays["rows"][0, :3] == pytest.approx([1.0, 2.0 + 0.23 + 0.035, 0.0], abs=1e-6)
    assert shaft.arrays["rows"][0, 7:] == pytest.approx([0.02, 0.02, 0.23])
    flat = only(draw("PoseArray", message)[0])
    assert flat.arrays["position"][1] == pytest.approx([1.0, 2.3, 0.0], abs=1e-6)


def test_a_covariance_is_an_ellipsoid_and_a_wedge():
    parts, _ = draw("PoseWithCovariance", estimate())
    sphere = next(one for one in parts if one.fields["shape"] == "sphere")
    assert sorted(sphere.arrays["rows"][0, 7:])[1:] == pytest.approx([0.4, 0.6], abs=1e-3)
    assert len(parts) == 4
    assert len(draw("PoseWithCovariance", estimate(), **{"Covariance/Value": False})[0]) == 2


def odometry(x, yaw=0.0):
    message = Odometry()
    message.header.frame_id = "odom"
    message.pose.pose = at(x, 0.0, yaw)
    return message


def test_odometry_leaves_a_trail_of_as_many_as_are_kept():
    made = drawer("Odometry", **{"Keep": 3, "Covariance/Value": False})
    for x in (0.0, 0.05, 0.2, 0.4, 0.6):  # the second is too near to the first
        made.take(odometry(x), Pose((0.0, 1.0, 0.0)), 0.0)
    shaft, _ = made.draw(MadeUpView())
    assert shaft.arrays["rows"][:, 0] == pytest.approx([0.7, 0.9, 1.1])  # their middles
    assert shaft.arrays["rows"][:, 1] == pytest.approx([1.0] * 3)
    assert made.draw(MadeUpView()) is None
    made.take(odometry(0.6, 1.0), IDENTITY, 0.0)
    assert len(made.draw(MadeUpView())[0].arrays["rows"]) == 3


def test_a_trail_without_a_limit_has_one(monkeypatch):
    monkeypatch.setattr(poses, "MOST_KEPT", 2)
    made = drawer("Odometry", **{"Keep": 0, "Covariance/Value": False})
    for x in range(5):
        made.take(odometry(float(x)), IDENTITY, 0.0)
    assert len(made.draw(MadeUpView())[0].arrays["rows"]) == 2


def test_points_are_balls_and_some_are_kept():
    made = drawer("PointStamped", **{"History Length": 2, "Radius": 0.3})
    for x in (1.0, 2.0, 3.0):
        made.take(PointStamped(point=Point(x, 0.0, 0.5)), Pose((10.0, 0.0, 0.0)), 0.0)
    balls = made.draw(MadeUpView())
    assert [one.arrays["rows"][0].tolist() for one in balls] == [
        pytest.approx([x, 0, 0.5, 0, 0, 0, 1, 0.3, 0.3, 0.3]) for x in (2, 3)]
    assert [one.pose.position for one in balls] == [(10.0, 0.0, 0.0)] * 2
    with pytest.raises(Problem, match="nans or infs"):
        draw("PointStamped", PointStamped(point=Point(math.nan, 0, 0)))


@pytest.mark.parametrize("turn, said", [(Quaternion(0, 0, 0, 5), "quaternions"),
                                        (Quaternion(math.nan, 0, 0, 1), "nans or infs")])
def test_what_is_no_rotation_is_refused(turn, said):
    message = particles()
    message.poses[3].orientation = turn
    with pytest.raises(Problem, match=said):
        draw("PoseArray", message)


def test_a_range_is_a_cone_with_its_tip_at_the_sensor():
    row = only(draw("Range", sonar())[0]).arrays["rows"][0]
    assert row[:3] == pytest.approx([0.6, 0.0, 0.0], abs=1e-6)  # its middle
    assert row[7:] == pytest.approx([2.4 * math.tan(0.25)] * 2 + [1.2], abs=1e-6)
    far = sonar()
    far.range = math.inf
    assert draw("Range", far)[0] == []


def test_frames_have_axes_names_and_arrows_and_lost_ones_are_listed():
    made, view = drawer("TF"), MadeUpView()
    view.parents = {"map": "", "odom": "map", "lost": "moon"}
    view.places["odom"] = Pose((1.0, 0.0, 0.0), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    parts = made.draw(view)
    texts = next(part for part in parts if part.kind == "texts").fields["texts"]
    assert [one["text"] for one in texts] == ["map", "odom"]
    assert made.statuses["lost"] == ("error", "No transform from [lost] to frame [map]")
    red = next(part for part in parts if part.arrays["colour"][0].tolist() == [255, 0, 0, 255])
    assert red.arrays["rows"][1, :3] == pytest.approx([1.0, 0.1, 0.0], abs=1e-6)  # x points to y


def test_a_grid_has_as_many_lines_as_its_cells_need():
    part = only(draw_fixed("Grid", **{"Plane Cell Count": 4, "Cell Size": 0.5}))
    assert part.arrays["position"].shape == (2 * 10, 3)
    assert np.abs(part.arrays["position"]).max() == 1.0
    with pytest.raises(Problem):
        draw_fixed("Axes", **{"Reference Frame": "lost"})


def test_a_grid_is_as_wide_as_its_style_says():
    widths = [only(draw_fixed("Grid", **{"Line Style/Value": style, "Line Style/Line Width": 0.03}))
              .fields["width"] for style in ("Lines", "Billboards")]
    assert widths == [0.0, 0.03]


def draw_fixed(name, **options):
    return drawer(name, **options).draw(MadeUpView())


def test_a_robot_is_its_links_and_what_tf_lacks_is_listed():
    made, view = drawer("RobotModel"), MadeUpView()
    with pytest.raises(Problem, match=r"Parameter \[robot_description\] does not exist"):
        made.draw(view)
    view.wall += 10.0
    view.parameters["robot_description"] = "base arm"
    view.places["base"] = Pose((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    part = only(made.draw(view))
    assert part.arrays["rows"].tolist() == [[1, 0, 0, 0, 0, 0, 1]]
    assert made.statuses["arm"] == ("error", "No transform from [arm] to [map]")
