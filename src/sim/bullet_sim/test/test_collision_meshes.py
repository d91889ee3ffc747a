"""What of a mesh the engine gets to see: of what moves each corner once, for it keeps them all."""

import numpy as np
import pytest
import trimesh

from bullet_sim.description import (
    Box,
    Collision,
    Inertial,
    LinkDescription,
    Mesh,
    ModelDescription,
    Plane,
)
from bullet_sim.physics import urdf_text
from bullet_sim.physics.urdf_text import MeshFiles
from bullet_sim.pose import Pose
from bullet_sim.world import World


@pytest.fixture
def ball(tmp_path):
    """An STL of 320 triangles with 162 corners."""
    trimesh.creation.icosphere(subdivisions=2, radius=0.5).export(tmp_path / "ball.stl")
    return Mesh(str(tmp_path / "ball.stl"))


def read(path):
    """Corners of the triangles of an OBJ file, (m, 3, 3) m, in its order."""
    with open(path, encoding="ascii") as file:
        rows = [line.split() for line in file]
    vertices = np.array([row[1:] for row in rows if row[0] == "v"], float)
    faces = np.array([row[1:] for row in rows if row[0] == "f"], int)
    return vertices[faces - 1]


def first_appearances(corners):
    return list(dict.fromkeys(map(tuple, corners.reshape(-1, 3).tolist())))


def test_of_a_hull_each_corner_is_read_once(ball, tmp_path):
    files = MeshFiles(tmp_path)
    whole, hull = read(files(ball, hull=False)), read(files(ball, hull=True))
    assert (len(whole), len(hull)) == (320, 54)
    inner = 0.5 / (0.5 - urdf_text.HULL_MARGIN)  # the engine adds its margin
    assert np.allclose(np.array(first_appearances(hull)) * inner, first_appearances(whole))


def test_a_hull_beside_its_origin_stays_there(tmp_path):
    """The engine's margin around it makes it as large as the mesh."""
    box = trimesh.creation.box((0.2, 0.4, 0.6))
    box.apply_translation((1.0, -2.0, 3.0))
    box.export(tmp_path / "box.stl")
    corners = read(MeshFiles(tmp_path)(Mesh(str(tmp_path / "box.stl")), hull=True)).reshape(-1, 3)
    margin = urdf_text.HULL_MARGIN
    assert corners.min(axis=0) == pytest.approx(np.array((0.9, -2.2, 2.7)) + margin)
    assert corners.max(axis=0) == pytest.approx(np.array((1.1, -1.8, 3.3)) - margin)


@pytest.mark.parametrize("size", [(0.2, 0.2, 0.2), (0.3, 0.1, 0.004), (0.2, 0.2, 0.0015)])
def test_a_box_of_triangles_is_as_high_as_a_box(tmp_path, size):
    trimesh.creation.box(size).export(tmp_path / "box.stl")
    solids = {"mesh": Mesh(str(tmp_path / "box.stl")), "box": Box(size)}
    world, heights = World(), {}
    world.spawn(ModelDescription("floor", static=True, links=(LinkDescription(
        "link", collisions=(Collision("c", Plane((0.0, 0.0, 1.0), (9.0, 9.0))),)),)))
    for x, (name, solid) in enumerate(solids.items()):
        link = LinkDescription("link", collisions=(Collision("c", solid),), inertial=Inertial(
            1.0, inertia=(0.01, 0.0, 0.0, 0.01, 0.0, 0.01)))
        heights[name] = world.spawn(ModelDescription(name, links=(link,)),
                                    Pose((x, 0.0, size[2] / 2)))
    world.step(500)
    thickest = max(0.0, urdf_text.HULL_MARGIN - size[2] / 2)  # no hull is thinner than its margin
    assert heights["mesh"].pose.position[2] == pytest.approx(
        heights["box"].pose.position[2] + thickest, abs=5e-5)
    world.close()


@pytest.mark.parametrize("corners, padded", [
    ([], []), ([5], [5, 5, 5]), ([5, 2], [5, 2, 5]), ([5, 2, 7], [5, 2, 7]),
    ([5, 2, 7, 1], [5, 2, 7, 1, 5, 2])])
def test_the_last_triangle_is_filled_up(corners, padded):
    faces = np.array([[corner] * 3 for corner in corners], np.uint32).reshape(-1, 3)
    assert urdf_text._each_once(faces).ravel().tolist() == padded


def drop(ball):
    """Where a ball of 1 kg is after it fell onto one of triangles that stands."""
    world = World()
    solid = Collision("c", ball)
    base = LinkDescription("link", collisions=(solid,))
    world.spawn(ModelDescription("base", static=True, links=(base,)))
    moving = LinkDescription("link", collisions=(solid,), inertial=Inertial(
        1.0, inertia=(0.1, 0.0, 0.0, 0.1, 0.0, 0.1)))
    model = world.spawn(ModelDescription("ball", links=(moving,)), Pose((0.05, 0.02, 1.1)))
    world.step(2000)
    pose = model.pose
    world.close()
    return pose


def test_nothing_falls_otherwise_for_that(ball, monkeypatch):
    once = drop(ball)
    assert once.position[2] < 0.9  # it has rolled off
    monkeypatch.setattr(urdf_text, "_each_once", lambda faces: faces)
    assert drop(ball) == once


@pytest.mark.parametrize("static, hull", [(True, False), (False, True)])
def test_what_stands_still_keeps_its_triangles(ball, monkeypatch, static, hull):
    asked, write = [], MeshFiles.__call__
    monkeypatch.setattr(MeshFiles, "__call__", lambda files, mesh, hull: (
        asked.append(hull), write(files, mesh, hull))[1])
    world = World()
    link = LinkDescription("link", collisions=(Collision("c", ball),))
    world.spawn(ModelDescription("m", static=static, links=(link,)))
    world.close()
    assert asked == [hull]
