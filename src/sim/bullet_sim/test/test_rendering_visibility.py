"""What can be in a picture, what is drawn first, and which of two planes at one height is seen."""

import math

import numpy as np
import pytest

from bullet_sim.description import Box, Material, Plane, SceneDescription, Visual
from bullet_sim.pose import IDENTITY, Pose
from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.rendering.frame import CameraView, projection_matrix, view_matrix
from bullet_sim.rendering.scene import Node, Scene, link_shape
from bullet_sim.rendering.visibility import Outlines

RED, BLUE = Material(diffuse=(1.0, 0.0, 0.0, 1.0)), Material(diffuse=(0.0, 0.0, 1.0, 1.0))


def cube(x, y=0.0, z=0.0, size=0.2, material=RED):
    return Visual("cube", Box((size, size, size)), Pose((x, y, z)), material)


def seen(*links, camera=Pose()):
    """Visibility for a camera of 90 degrees both ways that sees from 0.1 to 10 m."""
    nodes = [Node(link_shape(visuals), pose) for visuals, pose in links]
    view = CameraView(100, 100, math.pi / 2, 0.1, 10.0, camera)
    clip_world = projection_matrix(view) @ view_matrix(view.pose)
    outlines = Outlines([node.shape for node in nodes])
    return outlines.seen(nodes, clip_world, np.array(camera.position))


@pytest.mark.parametrize(("x", "y", "visible"), [
    (1.0, 0.0, True), (-1.0, 0.0, False), (1.0, 1.05, True), (1.0, 1.35, False),
    (1.0, -1.35, False), (0.1, 0.0, True), (-0.05, 0.0, False), (10.05, 0.0, True),
    (10.2, 0.0, False),
])
def test_a_part_is_seen_if_its_box_reaches_into_the_view(x, y, visible):
    found = seen(([cube(x, y)], Pose()))
    assert found.parts[0] == [visible]
    assert found.order == ([0] if visible else [])


def test_each_part_of_a_link_counts_by_itself():
    link = [cube(-1.0), cube(1.0, material=BLUE)]
    found = seen((link, Pose()))
    assert found.parts[0] == [False, True] and found.order == [0]


def test_a_part_around_the_camera_is_seen():
    assert seen(([cube(0.0, size=5.0)], Pose())).order == [0]


def test_poses_of_links_and_camera_count():
    turned = Pose.from_xyz_rpy((3.0, 0.0, 0.0), (0.0, 0.0, math.pi))
    link = [cube(1.0)]
    assert seen((link, Pose((1.0, 0.0, 0.0))), camera=turned).order == [0]
    assert seen((link, Pose((3.0, 0.0, 0.0))), camera=turned).order == []


def test_near_links_come_first_and_around_the_camera_small_ones():
    far, near = ([cube(4.0)], Pose()), ([cube(1.0)], Pose())
    around, wide = ([cube(0.0, size=1.0)], Pose()), ([cube(0.0, size=8.0)], Pose())
    assert seen(far, wide, near, around).order == [3, 1, 2, 0]


def test_links_without_anything_to_see_and_empty_scenes():
    assert seen(([], Pose()), ([cube(1.0)], Pose())).order == [1]
    assert seen().order == []


def plane(size: float, colour) -> Visual:
    lit = Material(emissive=colour, diffuse=(0, 0, 0, 1), ambient=(0, 0, 0, 1))
    return Visual("plane", Plane((0.0, 0.0, 1.0), (size, size)), material=lit)


@pytest.mark.parametrize("height, pitch", [(4.5, 1.5707), (0.117, 0.05), (20.0, 1.2)])
@pytest.mark.parametrize("first", ["ground", "course"])
def test_the_smaller_of_two_planes_at_one_height_is_on_top(height, pitch, first):
    scene = Scene(SceneDescription())
    visuals = {"ground": plane(100.0, (0.0, 0.0, 1.0, 1.0)), "course": plane(4.0, (1, 0, 0, 1))}
    turned = Pose.from_xyz_rpy((0, 0, 0), (0, 0, -1.54))
    for name in sorted(visuals, key=lambda name: name != first):
        scene.add_link((name, "link"), (visuals[name],), turned if name == "course" else IDENTITY)
    view = CameraView(640, 480, 0.2, 0.03, 100.0,
                      Pose.from_xyz_rpy((-height / np.tan(pitch), 0, height), (0, pitch, 0)))
    renderer = EglRenderer()
    middle = renderer.draw(scene, view).rgb[238:242, 310:330]
    renderer.close()
    assert np.all(middle == (255, 0, 0))
