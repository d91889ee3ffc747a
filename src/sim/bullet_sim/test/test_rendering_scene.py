"""The scene as data: names, shared shapes, materials that count, meshes that cannot be read."""

from __future__ import annotations

import logging

import numpy as np
import pytest
import trimesh

from bullet_sim.description import (
    Box,
    Cylinder,
    LightDescription,
    Material,
    Mesh,
    Plane,
    Sphere,
    Visual,
)
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.pose import Pose
from bullet_sim.rendering.primitives import primitive_part
from bullet_sim.rendering.scene import DEFAULT_MATERIAL, Scene

RED = Material(diffuse=(1.0, 0.0, 0.0, 1.0))
KEY = ("car", "base")


def test_version_grows_with_everything_but_poses():
    scene = Scene()
    seen = [scene.version]
    scene.add_light(LightDescription("sun"))
    seen.append(scene.version)
    scene.add_link(KEY, [Visual("v", Sphere(1.0))], Pose())
    seen.append(scene.version)
    scene.set_pose(KEY, Pose((1.0, 0.0, 0.0)))
    assert scene.version == seen[-1]
    assert scene.nodes[KEY].matrix[0, 3] == 1.0
    scene.remove_model("car")
    seen.append(scene.version)
    scene.remove_light("sun")
    seen.append(scene.version)
    assert seen == sorted(set(seen)) and not scene.nodes and not scene.lights


def test_wrong_names_say_what_there_is():
    scene = Scene()
    scene.add_link(KEY, [], Pose())
    scene.add_light(LightDescription("sun"))
    with pytest.raises(UnknownName, match="'car::wheel'; there are: car::base"):
        scene.set_pose(("car", "wheel"), Pose())
    with pytest.raises(UnknownName, match="'moon'; there are: sun"):
        scene.remove_light("moon")
    with pytest.raises(SimulationError, match="car::base"):
        scene.add_link(KEY, [], Pose())
    with pytest.raises(SimulationError, match="'sun'"):
        scene.add_light(LightDescription("sun"))
    scene.remove_model("bicycle")


def test_removing_a_model_leaves_the_others():
    scene = Scene()
    for key in [("a", "x"), ("a", "y"), ("b", "x")]:
        scene.add_link(key, [], Pose())
    scene.remove_model("a")
    assert list(scene.nodes) == [("b", "x")]


def test_links_that_look_alike_share_one_shape():
    scene = Scene()
    for name in ("a", "b"):
        scene.add_link((name, "base"), [Visual("v", Box((1.0, 1.0, 1.0)))], Pose())
    assert scene.nodes["a", "base"].shape is scene.nodes["b", "base"].shape


def test_shape_joins_equal_materials_and_keeps_within_its_sphere():
    visuals = [
        Visual("a", Box((1.0, 1.0, 1.0)), Pose((2.0, 0.0, 0.0)), RED),
        Visual("b", Sphere(0.5), Pose((-2.0, 0.0, 0.0)), RED),
        Visual("c", Sphere(0.5)),
    ]
    scene = Scene()
    scene.add_link(KEY, visuals, Pose())
    shape = scene.nodes[KEY].shape
    assert [part.material for part in shape.parts] == [RED, DEFAULT_MATERIAL]
    corners = np.concatenate([part.vertices for part in shape.parts])
    assert np.linalg.norm(corners - shape.centre, axis=1).max() <= shape.radius + 1e-6
    np.testing.assert_allclose(corners.max(axis=0), (2.5, 0.5, 0.5), atol=1e-6)


def test_transparency_thins_the_material():
    scene = Scene()
    scene.add_link(KEY, [Visual("v", Sphere(1.0), material=RED, transparency=0.75)], Pose())
    (part,) = scene.nodes[KEY].shape.parts
    assert part.material.diffuse == (1.0, 0.0, 0.0, 0.25)


def test_material_of_the_file_counts_unless_the_visual_has_one(tmp_path):
    (tmp_path / "m.mtl").write_text("newmtl leaf\nKd 0 1 0\n")
    (tmp_path / "m.obj").write_text(
        "mtllib m.mtl\nusemtl leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    )
    mesh = Mesh(str(tmp_path / "m.obj"))
    scene = Scene()
    scene.add_link(("a", "l"), [Visual("v", mesh)], Pose())
    scene.add_link(("b", "l"), [Visual("v", mesh, material=RED)], Pose())
    assert scene.nodes["a", "l"].shape.parts[0].material.diffuse == (0.0, 1.0, 0.0, 1.0)
    assert scene.nodes["b", "l"].shape.parts[0].material == RED


def test_mesh_that_cannot_be_read_is_one_warning_and_the_rest_stays(tmp_path, caplog):
    visuals = [
        Visual("hull", Mesh(str(tmp_path / "gone.dae"))),
        Visual("hood", Sphere(0.1)),
    ]
    scene = Scene()
    with caplog.at_level(logging.WARNING, logger="bullet_sim"):
        scene.add_link(KEY, visuals, Pose())
    (record,) = caplog.records
    for word in ("hull", "gone.dae", "No such file"):
        assert word in record.getMessage()
    assert len(scene.nodes[KEY].shape.parts) == 1


@pytest.mark.parametrize(("shape", "volume", "tolerance"), [
    (Box((1.0, 2.0, 3.0)), 6.0, 1e-6),
    (Cylinder(0.5, 2.0), np.pi / 2, 0.01),
    (Sphere(0.5), np.pi / 6, 0.03),
])
def test_primitives_are_closed_face_outwards_and_have_their_size(shape, volume, tolerance):
    part = primitive_part(shape)
    solid = trimesh.Trimesh(part.vertices, part.faces)
    assert solid.is_watertight and solid.is_winding_consistent
    assert solid.volume == pytest.approx(volume, rel=tolerance)
    flat = np.cross(*(part.vertices[part.faces[:, i]] - part.vertices[part.faces[:, 0]]
                      for i in (1, 2)))
    assert (np.sum(flat * part.normals[part.faces].mean(axis=1), axis=1) >= 0).all()
    assert part.uv.min() >= 0 and part.uv.max() <= 1


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, 1, 0), (0, -2, 1)])
def test_plane_faces_along_its_normal(normal):
    part = primitive_part(Plane(normal, (2.0, 1.0)))
    corners = part.vertices[part.faces[0]]
    facing = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    np.testing.assert_allclose(facing / np.linalg.norm(facing), part.normals[0], atol=1e-6)
    expected = np.array(normal) / np.linalg.norm(normal)
    np.testing.assert_allclose(part.normals[0], expected, atol=1e-6)
