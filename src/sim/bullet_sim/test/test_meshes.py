"""Mesh files of every kind against boxes whose numbers are known."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys

import numpy as np
import pytest
import trimesh

from bullet_sim.description import Mesh
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.meshes import loading
from bullet_sim.meshes.loading import collision_mesh, load_mesh
from bullet_sim.world import World

INERTIAL = """<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>"""


@pytest.fixture
def box():
    mesh = trimesh.creation.box((1.0, 2.0, 3.0))
    mesh.apply_translation((0.1, 0.2, 0.3))
    return mesh


def winding_normals(part):
    corners = part.vertices[part.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


@pytest.mark.parametrize("name", [
    "a.stl", "a.STL", "text.stl", "a.obj", "a.dae", "a.DAE", "a.ply", "a.off", "a.glb", "a.gltf"])
def test_box_of_every_format_has_its_size_and_faces_outwards(tmp_path, box, name):
    # conforms: mesh files, mesh files/.dae, mesh files/.stl, mesh files/.obj, mesh files/.ply
    # conforms: mesh files/.off, mesh files/.glb and .gltf, mesh files/names in capitals
    # conforms: mesh files/scale
    path = tmp_path / name
    kind = name.partition(".")[2].lower()
    exported = box.export(file_type="stl_ascii" if name.startswith("text") else kind)
    if kind == "gltf":
        for file, content in exported.items():
            (tmp_path / (name if file.endswith(".gltf") else file)).write_bytes(content)
    else:
        path.write_bytes(exported.encode() if isinstance(exported, str) else exported)
    for scale in ((2.0, 1.0, 0.5), (1.0, -1.0, 1.0)):  # the second mirrors it
        (part,) = load_mesh(Mesh(str(path), scale=scale))
        assert part.vertices.dtype == part.normals.dtype == np.float32
        ends = np.array([(-0.4, -0.8, -1.2), (0.6, 1.2, 1.8)]) * scale
        for limit in (np.min, np.max):
            np.testing.assert_allclose(limit(part.vertices, axis=0), limit(ends, axis=0), atol=1e-6)
        outward = part.vertices[part.faces].mean(axis=1) - np.array((0.1, 0.2, 0.3)) * scale
        assert (np.sum(winding_normals(part) * outward, axis=1) > 0).all()
        np.testing.assert_allclose(np.linalg.norm(part.normals, axis=1), 1, atol=1e-5)
        assert (np.sum(part.normals[part.faces[:, 0]] * winding_normals(part), axis=1) > 0).all()


def test_stl_text_with_two_solids(tmp_path):
    triangle = "FACET normal 0 0 1\n outer loop\n{}\n endloop\nendfacet\n"
    corners = ["vertex 0 0 {z}", "vertex 1.5e0 0 {z}", "VERTEX 0 +2 {z}"]
    path = tmp_path / "two.STL"
    path.write_text("".join(
        f"solid {name}\n" + triangle.format("\n".join(corners).format(z=z)) + f"endsolid {name}\n"
        for name, z in (("low one", "0"), ("high", "-.5"))
    ))
    low, _ = load_mesh(Mesh(str(path)))
    np.testing.assert_array_equal(low.vertices, [(0, 0, 0), (1.5, 0, 0), (0, 2, 0)])
    (high,) = load_mesh(Mesh(str(path), submesh="high"))
    np.testing.assert_array_equal(high.vertices[:, 2], [-0.5] * 3)
    with pytest.raises(FormatError, match="'middle'; there are: high, low one"):
        load_mesh(Mesh(str(path), submesh="middle"))


def test_binary_stl_whose_text_says_solid_or_whose_count_is_wrong(tmp_path, box):
    # conforms: mesh files/.stl that begins with solid, mesh files/.stl with a wrong count
    content = box.export(file_type="stl")
    for name, changed in [("solid.stl", b"solid " + content[6:]),
                          ("more.stl", content + b"appended"),
                          ("zero.stl", content[:80] + bytes(4) + content[84:])]:
        (tmp_path / name).write_bytes(changed)
        assert sum(len(part.faces) for part in load_mesh(Mesh(str(tmp_path / name)))) == 12


def test_the_robots_meshes_are_read_without_trimesh(tmp_path, box):
    """Its import costs more than all of a robot's spawning."""
    box.export(tmp_path / "box.stl")
    box.export(tmp_path / "box.dae")
    script = (
        "import sys; from bullet_sim.description import Mesh; "
        "from bullet_sim.meshes.loading import *;"
        f"load_mesh(Mesh({str(tmp_path / 'box.stl')!r}));"
        f"load_mesh(Mesh({str(tmp_path / 'box.dae')!r}));"
        "sys.exit(' '.join({'trimesh', 'scipy'} & sys.modules.keys()) or 0)"
    )
    subprocess.run([sys.executable, "-c", script], check=True)


WAVEFRONT = """mtllib sub\\a.mtl
v 0 0 0 0.5 0.5 0.5
v 1 0 0 0.5 0.5 0.5
v 1 1 0 0.5 0.5 0.5
v 0 1 0 0.5 0.5 0.5
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 2
o floor
usemtl red
f -4/-4 -3/-3 -2/-2 -1/-1
o wall
usemtl glass
f 1//1 2//1 3//1
f 1 3 \\
4
"""


def test_wavefront(tmp_path, caplog):
    # conforms: mesh files/.obj polygons, mesh files/.obj negative indices
    # conforms: mesh files/.mtl materials, mesh files/.mtl textures
    path = tmp_path / "a.obj"
    path.write_text(WAVEFRONT)
    (tmp_path / "a.mtl").write_text("newmtl red\r\nKd 1 0 0\r\nmap_Kd -s 2 2 2 skin.png\r\n"
                                    "newmtl glass\r\nKd 0 0 1\r\nTr 0.75\r\n")
    (tmp_path / "skin.png").touch()
    floor, wall = load_mesh(Mesh(str(path)))
    assert (len(floor.faces), len(wall.faces)) == (2, 2)
    assert floor.material.diffuse == (1, 0, 0, 1) and wall.material.diffuse == (0, 0, 1, 0.25)
    assert floor.material.texture == str(tmp_path / "skin.png")
    np.testing.assert_array_equal(floor.uv[:3], [(0, 0), (1, 0), (1, 1)])
    np.testing.assert_allclose(floor.normals, [(0, 0, 1)] * 4)  # of two triangles
    (only,) = load_mesh(Mesh(str(path), submesh="wall"))
    assert len(only.faces) == 2
    (tmp_path / "b.obj").write_text(WAVEFRONT.replace("a.mtl", "gone.mtl"))
    assert len(load_mesh(Mesh(str(tmp_path / "b.obj")))) == 2
    assert "material library sub\\gone.mtl not found" in caplog.text


def test_obj_with_two_materials(tmp_path):
    (tmp_path / "sign.png").write_bytes(b"not looked at when loading")
    (tmp_path / "two.mtl").write_text(
        "newmtl red\nKd 1 0 0\nd 0.5\n"
        "newmtl signed\nKd 1 1 1\nKs 0.5 0.5 0.5\nNs 20\nmap_Kd sign.png\n"
    )
    (tmp_path / "two.obj").write_text(
        "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "o first\nusemtl red\nf 1/1 2/2 3/3\no second\nusemtl signed\nf 1/1 3/3 4/4\n"
    )
    geometry = Mesh(str(tmp_path / "two.obj"))
    parts = {part.material.diffuse: part for part in load_mesh(geometry)}
    signed = parts[(1.0, 1.0, 1.0, 1.0)].material
    assert set(parts) == {(1.0, 0.0, 0.0, 0.5), (1.0, 1.0, 1.0, 1.0)}
    assert (signed.texture, signed.shininess) == (str(tmp_path / "sign.png"), 20.0)
    (second,) = load_mesh(Mesh(geometry.path, submesh="second"))
    assert sorted(second.uv.tolist()) == [[0, 0], [0, 1], [1, 1]]


@pytest.mark.parametrize("start", ["9/" * 1800, "9/" * 3000, "9" * 256])
def test_a_material_library_with_an_endless_name_is_warned_of_in_one_line(tmp_path, caplog, start):
    (tmp_path / "one.obj").write_text(
        f"mtllib {start}gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    load_mesh(Mesh(str(tmp_path / "one.obj")))
    (record,) = caplog.records
    assert "gone.mtl not found" in record.getMessage() and len(record.getMessage()) < 1000


def test_obj_without_its_material_library_still_loads(tmp_path):
    (tmp_path / "alone.obj").write_text(
        "mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl red\nf 1 2 3\n"
    )
    (part,) = load_mesh(Mesh(str(tmp_path / "alone.obj")))
    assert part.material is None and len(part.faces) == 1


@pytest.mark.parametrize("written", [
    "package://pkg/my%20meshes/a.stl", "package://pkg\\my meshes\\a.stl",
    "package://pkg/my meshes/a.stl", "file://{}/my%20meshes/a.stl", "{}/my meshes/a.stl"])
def test_names_of_files(tmp_path, box, written):
    # conforms: mesh files/percent-encoded names, mesh files/backslashes
    (tmp_path / "my meshes").mkdir()
    box.export(tmp_path / "my meshes/a.stl")
    shape = f'<geometry><mesh filename="{written.format(tmp_path)}"/></geometry>'
    text = f'<robot name="r"><link name="a">{INERTIAL}<visual>{shape}</visual></link></robot>'
    model = load_model(text, Resources(find_package={"pkg": str(tmp_path)}.__getitem__))
    assert model.links[0].visuals[0].geometry.path == str(tmp_path / "my meshes/a.stl")


@pytest.mark.parametrize(("name", "content", "reason"), [
    ("junk.stl", b"nonsense" * 30, "neither text nor binary STL"),
    ("empty.stl", b"", "neither text nor binary STL"),
    ("cut.stl", b"a header".ljust(80) + b"\2\0\0\0" + bytes(99),
     "the header says 2 triangles, 1 are there"),
    ("cut_text.stl", b"solid x\nvertex 0 0 0\nvertex 1 0 0\n", "'x' has a facet without three"),
    ("word.stl", b"solid\nvertex 0 0 zero\n", "could not convert string to float: 'zero'"),
    ("cut.dae", b"<COLLADA", "it is not well-formed XML: "),
    ("archive.dae", b"PK\3\4" + bytes(60), "it is a ZIP archive; unpack it"),
    ("text.obj", b"hello", "no triangles"),
    ("holes.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 7\n", "asks for v number 7, there are 2"),
    ("shape.step", b"ISO-10303", "unknown kind '.step'; there are: .dae, .glb, .gltf, .obj,"),
    ("gone.stl", None, "No such file"),
    ("cut.ply", b"ply\nformat", "cut.ply"), ("cut.glb", b"glTF", "cut.glb"),
])
def test_unreadable_mesh_is_one_line_with_file_and_reason(tmp_path, capfd, name, content, reason):
    # conforms: mesh files/broken files, mesh files/other kinds
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(FormatError) as caught:
        load_mesh(Mesh(str(path)))
    message = str(caught.value)
    assert str(path) in message and reason in message and "\n" not in message
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["a.dae", "a.3ds", "gone.dae"])
def test_a_robot_with_a_broken_mesh_still_spawns(tmp_path, caplog, name):
    # conforms: mesh files/broken files, mesh files/other kinds
    if not name.startswith("gone"):
        (tmp_path / name).write_bytes(b"<COLLADA")
    shape = f'<geometry><mesh filename="file://{tmp_path}/{name}"/></geometry>'
    ball = '<geometry><sphere radius="1"/></geometry>'
    text = (f'<robot name="r"><link name="a">{INERTIAL}<collision>{shape}</collision>'
            f"<collision>{ball}</collision></link></robot>")
    with contextlib.closing(World()) as world:
        model = world.spawn(load_model(text, Resources()))
        world.step(50)
        assert model.links.keys() == {"a"}
    (said,) = [one.getMessage() for one in caplog.records if name in one.getMessage()]
    assert said.endswith("; left out, the rest is loaded") or said.startswith(
        f"collision a_collision is left out: mesh {tmp_path}/{name}")


def test_huge_meshes_are_thinned_out(tmp_path, caplog, monkeypatch):
    # conforms: mesh files/huge files
    monkeypatch.setattr(loading, "MOST_DRAWN", 15_000)
    monkeypatch.setattr(loading, "MOST_COLLIDING", 6_000)
    monkeypatch.setattr(loading, "LARGEST_FILE", 2_000_000)
    sphere = trimesh.creation.icosphere(subdivisions=5)  # 20 480 triangles
    path = tmp_path / "ball.stl"
    path.write_bytes(sphere.export(file_type="stl"))
    (drawn,) = load_mesh(Mesh(str(path)))
    vertices, faces = collision_mesh(Mesh(str(path)))
    assert 7_000 < len(drawn.faces) <= 15_000
    assert 2_000 < len(faces) <= 6_000
    np.testing.assert_allclose(np.linalg.norm(vertices, axis=1), 1, atol=1e-2)
    assert caplog.text.count("has 20480 triangles and is drawn with") == 1
    path.write_bytes(bytes(3_000_000))
    with pytest.raises(FormatError, match="3 MB, more than 2; export it with fewer triangles"):
        load_mesh(Mesh(str(path)))


def test_loaded_once_until_the_file_changes(tmp_path, box):
    geometry = Mesh(str(tmp_path / "box.stl"))
    box.export(geometry.path)
    first = load_mesh(geometry)
    assert load_mesh(geometry) is first
    box.apply_scale(2)
    box.export(geometry.path)
    os.utime(geometry.path, ns=(1, 1))
    assert np.ptp(load_mesh(geometry)[0].vertices[:, 0]) == pytest.approx(2.0)


def test_collision_mesh_merges_corners(tmp_path, box):
    box.export(tmp_path / "box.stl")
    geometry = Mesh(str(tmp_path / "box.stl"), scale=(1.0, 1.0, 2.0))
    vertices, faces = collision_mesh(geometry)
    assert (vertices.shape, faces.shape) == ((8, 3), (12, 3))
    assert trimesh.Trimesh(vertices, faces).volume == pytest.approx(12.0)
