"""Mesh files of every common kind, and files that are broken, huge or named oddly."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from bullet_sim.description import Mesh
from bullet_sim.errors import FormatError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.meshes import collada, loading
from bullet_sim.meshes.loading import collision_mesh, load_mesh

INERTIAL = """<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>"""
DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_images><image id="i"><init_from>file://C:\\pictures\\skin.png</init_from></image>
  </library_images>
  <library_effects>
    <effect id="e1"><profile_COMMON><technique sid="t"><lambert><diffuse><color>1 0 0 1</color>
      </diffuse></lambert></technique></profile_COMMON></effect>
    <effect id="e2"><profile_COMMON>
      <newparam sid="u"><surface type="2D"><init_from>i</init_from></surface></newparam>
      <newparam sid="s"><sampler2D><source>u</source></sampler2D></newparam>
      <technique sid="t"><lambert><diffuse><texture texture="s" texcoord="UV"/></diffuse></lambert>
      </technique></profile_COMMON></effect></library_effects>
  <library_materials><material id="m1"><instance_effect url="#e1"/></material>
    <material id="m2"><instance_effect url="#e2"/></material></library_materials>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
      <accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
      <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
    </source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1" material="one"><input semantic="VERTEX" source="#v" offset="0"/>
      <p>0 1 2</p></triangles>
    <triangles count="1" material="two"><input semantic="VERTEX" source="#v" offset="0"/>
      <p>2 1 0</p></triangles></mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="w"><node><translate>0 0 100</translate>
    <node><scale>2 2 2</scale><instance_geometry url="#g"><bind_material><technique_common>
      <instance_material symbol="one" target="#m1"/><instance_material symbol="two" target="#m2"/>
    </technique_common></bind_material></instance_geometry></node></node></visual_scene>
  </library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


@pytest.fixture
def box():
    return trimesh.creation.box((1.0, 2.0, 3.0))


def bounds(parts):
    vertices = np.concatenate([part.vertices for part in parts])
    return vertices.min(axis=0), vertices.max(axis=0)


def volume(part):
    """That of a closed surface; negative if its triangles face inwards."""
    one, two, three = part.vertices[part.faces].astype(float).transpose(1, 0, 2)
    return np.einsum("ij,ij", one, np.cross(two, three)) / 6


@pytest.mark.parametrize("name", [
    "a.stl", "a.STL", "text.stl", "a.obj", "a.dae", "a.DAE", "a.ply", "a.off", "a.glb", "a.gltf"])
def test_every_kind_has_its_size(tmp_path, box, name):
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
    parts = load_mesh(Mesh(str(path), scale=(2.0, 1.0, -1.0)))
    low, high = bounds(parts)
    np.testing.assert_allclose(high - low, (2, 2, 3), atol=1e-6)
    assert sum(map(volume, parts)) == pytest.approx(12)  # mirrored, and still seen from outside
    vertices, faces = collision_mesh(Mesh(str(path)))
    assert (len(vertices), len(faces)) == (8, 12)


def test_collada(tmp_path, caplog):
    # conforms: mesh files/.dae units, mesh files/.dae instances, mesh files/.dae materials
    # conforms: mesh files/.dae textures, mesh files/missing textures
    path = tmp_path / "a.dae"
    path.write_text(DAE)
    red, plain = load_mesh(Mesh(str(path)))
    np.testing.assert_allclose(bounds([red]), [(0, 0, 1), (0.02, 0.02, 1)], atol=1e-7)
    assert red.material.diffuse == (1, 0, 0, 1)
    assert plain.material.texture is None and caplog.text.count("skin.png not found") == 1
    (tmp_path / "skin.png").touch()
    path.write_text(DAE + "\n")
    assert load_mesh(Mesh(str(path), (1, 1, 2)))[1].material.texture == str(tmp_path / "skin.png")


@pytest.mark.parametrize("bound, least, said", [
    ("MOST_NODES", 100, "its scene has more than 100 nodes, each counted as often as it is"),
    ("MOST_TRIANGLES", 799, "it has more than 799 triangles; export it with fewer")])
def test_nodes_that_come_again_and_again(tmp_path, monkeypatch, bound, least, said):
    # conforms: mesh files/.dae instances, mesh files/huge files
    twenty = "".join(f'<node id="n{level}">' + f'<instance_node url="#n{level - 1}"/>' * 20
                     + "</node>" for level in (1, 2))
    nodes = f'<library_nodes><node id="n0"><instance_geometry url="#g"/></node>{twenty}'
    path = tmp_path / "a.dae"
    scenes = "<library_visual_scenes>"
    path.write_text(DAE.replace(scenes, f"{nodes}</library_nodes>{scenes}")
                    .replace('<instance_geometry url="#g"><bind', '<instance_node url="#n2"/><bind')
                    .replace("</bind_material></instance_geometry>", "</bind_material>"))
    assert sum(len(part.faces) for part in load_mesh(Mesh(str(path)))) == 800
    monkeypatch.setattr(collada, bound, least)
    path.touch()
    with pytest.raises(FormatError, match=said):
        load_mesh(Mesh(str(path)))


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


def test_binary_stl_whose_text_says_solid_or_whose_count_is_wrong(tmp_path, box):
    # conforms: mesh files/.stl that begins with solid, mesh files/.stl with a wrong count
    content = box.export(file_type="stl")
    for name, changed in [("solid.stl", b"solid " + content[6:]),
                          ("more.stl", content + b"appended"),
                          ("zero.stl", content[:80] + bytes(4) + content[84:])]:
        (tmp_path / name).write_bytes(changed)
        assert sum(len(part.faces) for part in load_mesh(Mesh(str(tmp_path / name)))) == 12
    (tmp_path / "cut.stl").write_bytes(content[:-200])
    with pytest.raises(FormatError, match="cut off: the header says 12 triangles, 8 are there"):
        load_mesh(Mesh(str(tmp_path / "cut.stl")))


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


@pytest.mark.parametrize("name, content", [
    ("a.dae", b"<COLLADA"), ("a.stl", b"solid"), ("a.obj", b""), ("a.ply", b"ply\nformat"),
    ("a.3ds", b"MM"), ("a.glb", b"glTF"), ("gone.dae", None)])
def test_a_robot_with_a_broken_mesh_still_spawns(bench, tmp_path, caplog, name, content):
    # conforms: mesh files/broken files, mesh files/other kinds
    if content is not None:
        (tmp_path / name).write_bytes(content)
    shape = f'<geometry><mesh filename="file://{tmp_path}/{name}"/></geometry>'
    bench.spawn(f"""<robot name="r"><link name="a">{INERTIAL}<collision>{shape}</collision>
        <collision><geometry><sphere radius="1"/></geometry></collision></link></robot>""")
    bench.run(0.05)
    assert bench.world.models["r"].links.keys() == {"a"}
    (said,) = [one.getMessage() for one in caplog.records if name in one.getMessage()]
    if content is None:
        assert said.endswith("; left out, the rest is loaded")
    else:
        assert said.startswith(f"collision a_collision is left out: mesh {tmp_path}/{name}")


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
