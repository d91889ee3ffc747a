"""Coarser meshes: fewer triangles within a bound, shaded as before."""

import itertools
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import trimesh

from bullet_sim.meshes import detail
from bullet_sim.meshes.detail import levels
from bullet_sim.meshes.part import MeshPart, grid_faces
from bullet_sim.meshes.smoothing import smooth_shaded

RADIUS = 0.5  # m


def part_of(mesh: trimesh.Trimesh) -> MeshPart:
    return smooth_shaded(mesh.vertices, mesh.faces)


def ball() -> MeshPart:
    return part_of(trimesh.creation.icosphere(4, RADIUS))


def finely_cut_box() -> MeshPart:
    box = trimesh.creation.box((1.0, 0.5, 0.25))
    return part_of(box.subdivide().subdivide().subdivide().subdivide())


def sampled(part: MeshPart) -> np.ndarray:
    """Points (n, 3) of its surface: corners, middles of edges and of triangles."""
    corners = part.vertices[part.faces].astype(float)
    return np.concatenate([corners.reshape(-1, 3), corners.mean(axis=1),
                           ((corners + np.roll(corners, 1, axis=1)) / 2).reshape(-1, 3)])


def last(part: MeshPart) -> MeshPart:
    return levels(part)[-1].part


def test_normals_are_the_mesh_s_own():
    """A few triangles, and yet as round."""
    for level in levels(ball()):
        outwards = level.part.vertices / np.linalg.norm(level.part.vertices, axis=1, keepdims=True)
        assert (np.sum(level.part.normals * outwards, axis=1) > np.cos(np.radians(1.5))).all()


def test_flat_faces_are_left_with_their_corners_and_edges_stay_sharp():
    box = finely_cut_box()
    assert len(box.faces) == 3072
    coarse = levels(box)[0].part
    assert len(coarse.faces) < 60
    np.testing.assert_allclose(coarse.vertices.min(axis=0), (-0.5, -0.25, -0.125), atol=1e-6)
    np.testing.assert_allclose(abs(coarse.normals).max(axis=1), 1.0, atol=1e-3)
    corners = coarse.vertices[coarse.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sum(across * coarse.normals[coarse.faces[:, 0]], axis=1) > 0).all()
    area = np.linalg.norm(across, axis=1).sum() / 2
    assert area == pytest.approx(2 * (0.5 + 0.25 + 0.125), rel=1e-4)


def test_an_open_sheet_keeps_its_edge():
    x, y = np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 40))
    grid = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    corner = np.arange(39 * 40).reshape(39, 40)[:, :39].ravel()
    faces = np.concatenate([np.stack([corner, corner + 1, corner + 41], axis=1),
                            np.stack([corner, corner + 41, corner + 40], axis=1)])
    coarse = last(smooth_shaded(grid, faces))
    corners = coarse.vertices[coarse.faces]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2].sum() / 2
    assert area == pytest.approx(1.0) and len(coarse.faces) < len(faces) / 10


def test_a_sheet_with_two_sides_is_left_as_it_is():
    """Its rim could be drawn inwards without leaving any plane."""
    x, y = np.meshgrid(np.linspace(-1, 1, 30), np.linspace(-1, 1, 30))
    bowl = np.stack([x.ravel(), y.ravel(), (x ** 2 + y ** 2).ravel() / 4], axis=1)
    corner = np.arange(29 * 30).reshape(29, 30)[:, :29].ravel()
    front = np.concatenate([np.stack([corner, corner + 1, corner + 31], axis=1),
                            np.stack([corner, corner + 31, corner + 30], axis=1)])
    assert levels(smooth_shaded(bowl, front))
    assert levels(smooth_shaded(bowl, np.concatenate([front, front[:, ::-1]]))) == []
    # The back of other triangles.
    other = np.concatenate([np.stack([corner, corner + 30, corner + 1], axis=1),
                            np.stack([corner + 1, corner + 30, corner + 31], axis=1)])
    assert levels(smooth_shaded(bowl, np.concatenate([front, other]))) == []
    # Loose triangles, each twice.
    loose = np.random.default_rng(3).normal(size=(300, 3, 3)).reshape(-1, 3)
    faces = np.arange(900).reshape(-1, 3)
    assert levels(smooth_shaded(loose, np.concatenate([faces, faces[:, ::-1]]))) == []


def test_a_fold_keeps_its_triangles_and_the_rest_gets_coarser():
    """A ball on a post that is wider than the neck between them."""
    angle = np.linspace(0.0, 2 * np.pi, 65)
    angle[-1] = 0.0
    bend = np.linspace(-1.5, 1.57, 60)
    radius = np.concatenate([np.full(20, 0.02), 0.06 * np.cos(bend)])
    height = np.concatenate([np.linspace(0.0, 0.33, 20), 0.39 + 0.06 * np.sin(bend)])
    vertices = np.stack([np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)),
                         np.repeat(height[:, None], 65, axis=1)], axis=-1).reshape(-1, 3)
    post = smooth_shaded(vertices, grid_faces(80, 65))
    found = levels(post)
    assert len(found) > 2 and len(found[-1].part.faces) < len(post.faces) / 4
    for level in found:
        places = sampled(level.part)
        across = np.hypot(places[:, 0], places[:, 1])
        in_post = places[:, 2] < 0.325
        assert (abs(across[in_post] - 0.02) < level.tolerance + 0.0002).all()
        from_middle = np.hypot(across, places[:, 2] - 0.39)
        assert (abs(from_middle - 0.06)[places[:, 2] > 0.335] < level.tolerance + 0.0002).all()


def test_very_many_triangles_at_a_corner_take_no_time():
    count = 100_000
    angle = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    cone = np.concatenate([[(0, 0, 0.1)],
                           np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)])
    rim = np.arange(count)
    faces = np.stack([0 * rim, 1 + rim, 1 + (rim + 1) % count], axis=1)
    mixed = np.random.default_rng(0).permutation(faces)
    part = smooth_shaded(cone, mixed)  # ten minutes, if it took a turn for each triangle
    assert len(part.vertices) == count + 1 and levels(part) == []


def test_threads_do_not_disturb_each_other():
    parts = [part_of(trimesh.creation.icosphere(4, radius)) for radius in (0.2, 0.5, 1.0, 3.0)]
    alone = [levels(part) for part in parts]
    with ThreadPoolExecutor(4) as pool:
        for _ in range(3):
            for one, other in zip(alone, pool.map(levels, parts), strict=True):
                for level, again in zip(one, other, strict=True):
                    np.testing.assert_array_equal(level.part.vertices, again.part.vertices)


def test_levels_are_ever_coarser_and_keep_their_word():
    part = ball()
    found = levels(part)
    assert len(found) >= 3
    for finer, coarser in itertools.pairwise(found):
        assert coarser.tolerance >= 2 * finer.tolerance
        assert len(coarser.part.faces) <= detail.GAIN * len(finer.part.faces)
    for level in found:
        # The icosphere itself is up to 0.6 mm below the sphere that its corners lie on.
        away = abs(np.linalg.norm(sampled(level.part), axis=1) - RADIUS)
        assert away.max() < level.tolerance + 0.0006
    assert len(found[-1].part.faces) < len(part.faces) / 8


def test_small_meshes_stay_as_they_are():
    assert levels(part_of(trimesh.creation.icosphere(2))) == []  # 320 triangles


def test_equal_meshes_give_equal_levels():
    for one, other in zip(levels(ball()), levels(ball()), strict=True):
        np.testing.assert_array_equal(one.part.vertices, other.part.vertices)
        np.testing.assert_array_equal(one.part.faces, other.part.faces)


@pytest.mark.parametrize("broken", [
    np.zeros((600, 3, 3)),  # all in one place
    np.repeat(np.random.default_rng(1).normal(size=(300, 3, 3)), 2, axis=0),  # each twice
    np.random.default_rng(2).normal(size=(600, 3, 3)),  # a heap that hangs together nowhere
])
def test_broken_meshes_are_drawn_all_the_same(broken):
    part = smooth_shaded(broken.reshape(-1, 3), np.arange(1800).reshape(-1, 3))
    for level in levels(part):
        assert np.isfinite(level.part.vertices).all() and np.isfinite(level.part.normals).all()


@pytest.mark.parametrize("corners", [1, 3, 7])
def test_a_part_of_few_corners_gives_their_normals(corners):
    up = np.tile(np.float32([0, 0, 1]), (corners, 1))
    places = np.float32([[number, number % 2, 0] for number in range(corners)])
    part = MeshPart(places, up, None, np.zeros((1, 3), np.uint32))
    coarse = detail._Shading(part).of(np.array([[[0, 0, 0], [6, 0, 0], [0, 6, 0]]], float))
    assert coarse.normals == pytest.approx(np.tile([0, 0, 1], (3, 1)))
