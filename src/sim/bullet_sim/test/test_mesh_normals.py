"""Normals of files without any: smooth where a surface is curved, sharp at its edges."""

import math

import numpy as np
import pytest
import trimesh

from bullet_sim.description import Mesh
from bullet_sim.meshes.loading import load_mesh
from bullet_sim.meshes.part import equal_rows, face_normals, welded
from bullet_sim.meshes.smoothing import smooth_shaded

SIDES = 24  # of a cylinder, which meet at 15 degrees


def cylinder(sides=SIDES):
    made = trimesh.creation.cylinder(0.5, 2.0, sections=sides)
    return smooth_shaded(made.vertices, made.faces)


def test_a_cylinder_is_round_and_its_ends_are_flat():
    part = cylinder()
    end = abs(part.normals[:, 2]) > 0.5
    np.testing.assert_allclose(abs(part.normals[end]), np.tile((0, 0, 1), (end.sum(), 1)),
                               atol=1e-6)
    round_ones = part.vertices[~end] * (2, 2, 0)
    np.testing.assert_allclose(part.normals[~end], round_ones, atol=1e-6)
    assert len(part.vertices) == 2 * (SIDES + 1) + 2 * SIDES  # ends with their middles, and sides
    assert len(part.faces) == 4 * SIDES


@pytest.mark.parametrize("sides, smooth", [(13, True), (11, False)])
def test_an_edge_of_more_than_30_degrees_is_seen(sides, smooth):
    part = cylinder(sides)
    side = abs(part.normals[:, 2]) < 0.5
    assert len(part.vertices[side]) == (2 if smooth else 4) * sides


def test_it_does_not_matter_how_a_face_is_cut_up():
    """A roof's ridge points up, though one of its ends has two triangles on this side and one on
    that."""
    fall = math.tan(math.radians(5))
    roof = np.array([(x, y, -abs(x) * fall) for x in (1, 0, -1) for y in (0, 1)], float)
    faces = np.array([(0, 1, 3), (0, 3, 2), (2, 3, 5), (2, 5, 4)])
    part = smooth_shaded(roof, faces)
    assert len(part.vertices) == 6
    ridge = part.vertices[:, 0] == 0
    np.testing.assert_allclose(part.normals[ridge], [(0, 0, 1)] * 2, atol=1e-6)


def test_surfaces_that_only_touch_at_a_corner_stay_apart():
    one = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], float)
    two = np.array([(0, 0, 0), (-1, 0, 0.1), (0, -1, 0.1)], float)
    part = smooth_shaded(np.concatenate([one, two]), np.arange(6).reshape(2, 3))
    assert len(part.vertices) == 6
    np.testing.assert_allclose(part.normals[:3], [(0, 0, 1)] * 3, atol=1e-6)


def test_a_triangle_without_area_harms_nobody():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0)], float)
    part = smooth_shaded(vertices, np.array([(0, 1, 2), (0, 3, 1), (0, 0, 0)]))
    assert np.isfinite(part.normals).all() and len(part.faces) == 3
    np.testing.assert_allclose(part.normals[part.faces[0]], [(0, 0, 1)] * 3)


def test_corners_with_other_image_coordinates_are_not_shared():
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    faces = np.array([(0, 1, 2), (0, 2, 3)])
    assert len(smooth_shaded(square, faces).vertices) == 4
    seam = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 0.5)])
    corners = square[faces.ravel()]
    part = smooth_shaded(corners, np.arange(6).reshape(2, 3), seam)
    assert len(part.vertices) == 4 and len(part.uv) == 4
    seam[3:] += 0.25
    part = smooth_shaded(corners, np.arange(6).reshape(2, 3), seam)
    assert len(part.vertices) == 6
    np.testing.assert_allclose(part.uv[part.faces].reshape(-1, 2), seam)


def test_welding_changes_nothing_that_is_drawn(tmp_path):
    trimesh.creation.icosphere(3).export(tmp_path / "ball.stl")
    (part,) = load_mesh(Mesh(str(tmp_path / "ball.stl")))
    assert len(part.vertices) == 642  # corners of 1280 triangles
    np.testing.assert_allclose(part.normals, part.vertices, atol=0.01)
    loose = part.faces.ravel()
    apart = type(part)(part.vertices[loose], part.normals[loose], None,
                       np.arange(len(loose), dtype=np.uint32).reshape(-1, 3))
    again = welded(apart)
    assert len(again.vertices) == 642 and again.faces.dtype == np.uint32
    np.testing.assert_array_equal(again.vertices[again.faces], part.vertices[part.faces])
    np.testing.assert_array_equal(again.normals[again.faces], part.normals[part.faces])


def test_equal_rows_are_found_in_their_order():
    rows = np.array([(2, 0.0), (1, 5), (2, -0.0), (3, 1), (1, 5)], np.float32)
    kept, place = equal_rows(rows)
    assert kept.tolist() == [0, 1, 3] and place.tolist() == [0, 1, 0, 2, 1]
    many = np.random.default_rng(0).integers(0, 30, (5000, 3)).astype(np.float32)
    kept, place = equal_rows(many)
    np.testing.assert_array_equal(many[kept][place], many)
    assert len(kept) == len(np.unique(many, axis=0)) and (np.diff(kept) > 0).all()


def test_rows_of_one_key_are_told_apart(monkeypatch):
    monkeypatch.setattr("bullet_sim.meshes.part._ODD", np.zeros(8, np.uint64))
    rows = np.array([(1, 2), (3, 4), (1, 2)], np.float32)
    kept, place = equal_rows(rows)
    assert kept.tolist() == [0, 1] and place.tolist() == [0, 1, 0]


def test_the_normal_of_a_face_points_where_it_turns_left():
    corners = np.array([[(0, 0, 0), (1, 0, 0), (0, 2, 0)], [(0, 0, 0)] * 3], float)
    np.testing.assert_array_equal(face_normals(corners), [(0, 0, 1), (0, 0, 0)])
