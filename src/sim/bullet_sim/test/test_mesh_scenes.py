"""glTF, PLY and OFF files, and what becomes of files of very many triangles."""

import json
import math

import numpy as np
import pytest
import trimesh

from bullet_sim.description import Mesh
from bullet_sim.errors import FormatError
from bullet_sim.meshes import loading
from bullet_sim.meshes.detail import cluster
from bullet_sim.meshes.loading import collision_mesh, load_mesh


def extent(parts) -> tuple[list, list]:
    """Low and high corner of all parts."""
    vertices = np.concatenate([part.vertices for part in parts])
    return vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()


def volume(vertices, faces) -> float:
    """m^3; positive if the triangles face outwards."""
    a, b, c = np.asarray(vertices, float)[faces].transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum() / 6)


def box(*size, colour=None) -> trimesh.Trimesh:
    mesh = trimesh.creation.box(size)
    if colour:
        mesh.visual = trimesh.visual.TextureVisuals(
            material=trimesh.visual.material.PBRMaterial(baseColorFactor=colour))
    return mesh


@pytest.mark.parametrize("name", ["a.ply", "a.off"])
def test_a_single_mesh_keeps_its_numbers(tmp_path, name):
    box(1.0, 2.0, 3.0).export(tmp_path / name)
    (part,) = load_mesh(Mesh(str(tmp_path / name)))
    assert extent([part]) == ([-0.5, -1.0, -1.5], [0.5, 1.0, 1.5])
    assert volume(part.vertices, part.faces) == pytest.approx(6.0)
    assert part.material is None


@pytest.fixture
def scene(tmp_path):
    """A red, half transparent box at x = 10, and one that its node mirrors to x = -3."""
    made = trimesh.Scene()
    made.add_geometry(box(1.0, 1.0, 2.0, colour=(255, 51, 0, 102)), node_name="red",
                      transform=trimesh.transformations.translation_matrix((10, 0, 0)))
    other = box(2.0, 1.0, 1.0)
    other.apply_translation((3.0, 0.0, 0.0))
    made.add_geometry(other, node_name="mirrored", transform=np.diag([-1.0, 1.0, 1.0, 1.0]))
    made.add_geometry(trimesh.PointCloud([(50.0, 50.0, 50.0)]), node_name="points")
    path = tmp_path / "scene.glb"
    path.write_bytes(made.export(file_type="glb"))
    return path


def test_parts_of_a_scene_are_where_their_nodes_are(scene):
    red, = load_mesh(Mesh(str(scene), submesh="red"))
    mirrored, = load_mesh(Mesh(str(scene), submesh="mirrored"))
    assert len(load_mesh(Mesh(str(scene)))) == 2  # the points are no surface
    assert extent([red]) == ([9.5, -0.5, -1.0], [10.5, 0.5, 1.0])
    assert extent([mirrored]) == ([-4.0, -0.5, -0.5], [-2.0, 0.5, 0.5])
    assert volume(mirrored.vertices, mirrored.faces) == pytest.approx(2.0)  # it faces outwards


def test_a_base_colour_is_the_material(scene):
    red, = load_mesh(Mesh(str(scene), submesh="red"))
    assert red.material.diffuse == pytest.approx((1.0, 0.2, 0.0, 0.4))
    assert red.material.ambient == pytest.approx((1.0, 0.2, 0.0, 1.0))


def gltf(tmp_path, buffer: str):
    """One triangle whose numbers are in a file beside it."""
    numbers = np.array([(0, 0, 0), (1, 0, 0), (0, 2, 0)], np.float32).tobytes()
    numbers += np.array([0, 1, 2], np.uint32).tobytes()
    (tmp_path / "there.bin").write_bytes(numbers)
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"uri": buffer, "byteLength": len(numbers)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [0, 0, 0], "max": [1, 2, 0]},
            {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}]}))
    return path


def test_a_gltf_file_reads_what_is_beside_it(tmp_path):
    parts = load_mesh(Mesh(str(gltf(tmp_path, "there.bin"))))
    assert extent(parts) == ([0.0, 0.0, 0.0], [1.0, 2.0, 0.0])


def test_a_gltf_file_without_its_buffer_is_one_line(tmp_path):
    with pytest.raises(FormatError, match=r"a\.gltf cannot be read: .*missing\.bin"):
        load_mesh(Mesh(str(gltf(tmp_path, "missing.bin"))))


# --- fewer triangles

BALL = trimesh.creation.icosphere(subdivisions=4, radius=1.0)  # 5120 triangles


@pytest.mark.parametrize("limit", [3000, 1000, 200])
def test_fewer_triangles_stay_close_to_the_surface(limit):
    kept, faces = cluster(BALL.vertices, BALL.faces, limit)
    assert 0.2 * limit < len(faces) <= limit
    assert faces.max() < len(kept)
    assert np.linalg.norm(BALL.vertices[kept], axis=1) == pytest.approx(1.0)  # corners of the ball
    assert volume(BALL.vertices[kept], faces) == pytest.approx(4 / 3 * math.pi, rel=0.25)
    assert (faces != np.roll(faces, 1, axis=1)).all()  # none is a line or a point


def test_equal_triangles_become_one():
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.01, 0, 0), (0.99, 0, 0), (0, 0.99, 0),
                        (1.05, 1.05, 0)])  # the last one makes cells of 15 cm
    first, same, line = (0, 1, 2), (5, 3, 4), (0, 3, 1)
    kept, faces = cluster(corners, np.array([first, same, line]), 100)
    assert len(faces) == 1
    assert sorted(kept[faces[0]]) == [0, 1, 2]


def test_a_single_point_has_no_triangles_left():
    kept, faces = cluster(np.ones((3, 3)), np.array([(0, 1, 2)]), 100)
    assert (len(kept), len(faces)) == (1, 0)


def test_a_large_file_is_drawn_with_fewer_and_said_once(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(loading, "MOST_DRAWN", 1000)
    BALL.export(tmp_path / "ball.ply")
    for _ in range(2):
        (part,) = load_mesh(Mesh(str(tmp_path / "ball.ply")))
    assert 200 < len(part.faces) <= 1000
    (record,) = caplog.records
    assert record.getMessage() == (
        f"mesh {tmp_path}/ball.ply has 5120 triangles and is drawn with {len(part.faces)}; "
        "export it with at most 1000")


def test_a_large_file_collides_with_fewer(tmp_path, monkeypatch):
    monkeypatch.setattr(loading, "MOST_COLLIDING", 500)
    BALL.export(tmp_path / "ball.off")
    vertices, faces = collision_mesh(Mesh(str(tmp_path / "ball.off")))
    assert 100 < len(faces) <= 500
    assert np.linalg.norm(vertices, axis=1) == pytest.approx(1.0, abs=1e-5)
