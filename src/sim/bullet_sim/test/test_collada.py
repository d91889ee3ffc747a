"""COLLADA files: units, materials, nodes, and files that are not whole."""

import time

import numpy as np
import pytest
from lxml import etree

from bullet_sim.description import Mesh
from bullet_sim.errors import FormatError
from bullet_sim.meshes import collada
from bullet_sim.meshes.collada import without_dangling
from bullet_sim.meshes.loading import load_mesh

DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
    <unit name="part" meter="{unit}"/><up_axis>{up}</up_axis></asset>
  <library_images><image id="img"><init_from>{image}</init_from></image></library_images>
  <library_effects>
    <effect id="painted"><profile_COMMON><technique sid="t"><lambert>
      <diffuse><color>0.2 0.4 0.6 1</color></diffuse>
      <transparent opaque="A_ONE"><color>1 1 1 1</color></transparent>
      <transparency><float>0.25</float></transparency>
    </lambert></technique></profile_COMMON></effect>
    <effect id="pictured"><profile_COMMON>
      <newparam sid="surface"><surface type="2D"><init_from>img</init_from></surface></newparam>
      <newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
      <technique sid="t"><lambert>
        <diffuse><texture texture="sampler" texcoord="UV"/></diffuse>
      </lambert></technique></profile_COMMON></effect>
  </library_effects>
  <library_materials>
    <material id="m1"><instance_effect url="#painted"/></material>
    <material id="m2"><instance_effect url="#pictured"/></material>
  </library_materials>
  <library_geometries><geometry id="tri"><mesh>
    <source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
      <technique_common><accessor source="#pa" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <source id="t"><float_array id="ta" count="6">0 0 1 0 0 1</float_array>
      <technique_common><accessor source="#ta" count="3" stride="2">
        <param name="S" type="float"/><param name="T" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1" material="sym"><input semantic="VERTEX" source="#v" offset="0"/>
      <input semantic="TEXCOORD" source="#t" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s">
    <node id="a" name="left"><translate>10 0 0</translate>
      <instance_geometry url="#tri"><bind_material><technique_common>
        <instance_material symbol="sym" target="#m1"/></technique_common></bind_material>
      </instance_geometry></node>
    <node id="b" name="right"><scale>-1 1 1</scale>
      <instance_geometry url="#tri"><bind_material><technique_common>
        <instance_material symbol="sym" target="#m2"/></technique_common></bind_material>
      </instance_geometry></node>
  </visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""


@pytest.fixture
def dae(tmp_path):
    """A triangle twice, in centimetres and Y_UP: painted and moved, then pictured and mirrored."""
    (tmp_path / "picture.png").write_bytes(b"not looked at when loading")
    path = tmp_path / "two.dae"
    path.write_text(DAE.format(unit="0.01", up="Y_UP", image="picture.png"))
    return path


def winding_normals(part):
    corners = part.vertices[part.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_collada_unit_counts_and_up_axis_does_not(dae):
    # conforms: mesh files/.dae units, mesh files/.dae instances
    left, right = load_mesh(Mesh(str(dae)))
    np.testing.assert_allclose(
        left.vertices, [(0.1, 0, 0), (0.11, 0, 0), (0.1, 0.02, 0)], atol=1e-7
    )
    np.testing.assert_allclose(right.vertices.min(axis=0), (-0.01, 0, 0), atol=1e-7)
    np.testing.assert_allclose(winding_normals(left), [(0, 0, 1)], atol=1e-6)
    np.testing.assert_allclose(winding_normals(right), [(0, 0, 1)], atol=1e-6)


def test_collada_materials(dae):
    # conforms: mesh files/.dae materials, mesh files/.dae textures
    left, right = load_mesh(Mesh(str(dae)))
    assert left.material.diffuse == pytest.approx((0.2, 0.4, 0.6, 0.25))
    assert left.material.texture is None
    assert right.material.texture == str(dae.parent / "picture.png")
    places = 100 * right.vertices * (-1, 0.5, 1)  # as in the file, where uv is x and y
    np.testing.assert_allclose(right.uv, places[:, :2], atol=1e-6)


def test_a_missing_texture_is_one_warning_and_a_windows_path_is_looked_for_by_name(dae, caplog):
    # conforms: mesh files/missing textures
    dae.write_text(DAE.format(unit="0.01", up="Y_UP", image="file://C:\\pictures\\picture.png"))
    assert load_mesh(Mesh(str(dae)))[1].material.texture == str(dae.with_name("picture.png"))
    dae.with_name("picture.png").unlink()
    assert load_mesh(Mesh(str(dae), (1, 1, 2)))[1].material.texture is None
    assert caplog.text.count("picture.png not found") == 1


def test_submesh_is_a_collada_node_and_can_be_centred(dae):
    (part,) = load_mesh(Mesh(str(dae), submesh="left", centre_submesh=True))
    np.testing.assert_allclose(part.vertices.min(axis=0), (-0.005, -0.01, 0), atol=1e-7)
    np.testing.assert_allclose(part.vertices.max(axis=0), (0.005, 0.01, 0), atol=1e-7)
    with pytest.raises(FormatError, match="'middle'; there are: left, right"):
        load_mesh(Mesh(str(dae), submesh="middle"))


@pytest.mark.parametrize("bound, least, said", [
    ("MOST_NODES", 100, "its scene has more than 100 nodes, each counted as often as it is"),
    ("MOST_TRIANGLES", 400, "it has more than 400 triangles; export it with fewer")])
def test_nodes_that_come_again_and_again(dae, monkeypatch, bound, least, said):
    # conforms: mesh files/.dae instances, mesh files/huge files
    twenty = "".join(f'<node id="n{level}">' + f'<instance_node url="#n{level - 1}"/>' * 20
                     + "</node>" for level in (1, 2))
    nodes = f'<library_nodes><node id="n0"><instance_geometry url="#tri"/></node>{twenty}'
    scenes, left = "<library_visual_scenes>", '<node id="a" name="left">'
    dae.write_text(dae.read_text().replace(scenes, f"{nodes}</library_nodes>{scenes}")
                   .replace(left, f'{left}<instance_node url="#n2"/>'))
    assert sum(len(part.faces) for part in load_mesh(Mesh(str(dae)))) == 402
    monkeypatch.setattr(collada, bound, least)
    dae.touch()
    with pytest.raises(FormatError, match=said):
        load_mesh(Mesh(str(dae)))


def test_a_matrix_that_flattens_leaves_a_floor(tmp_path):
    path = tmp_path / "flat.dae"
    flat = "<matrix>1 0 0 0  0 1 0 0  0 0 0 0.5  0 0 0 1</matrix>"
    text = DAE.format(unit="1", up="Z_UP", image="i.png")
    normals = ('<source id="n"><float_array id="na" count="9">0 0 1 0 0 1 0 0 1</float_array>'
               '<technique_common><accessor source="#na" count="3" stride="3">'
               '<param name="X" type="float"/><param name="Y" type="float"/>'
               '<param name="Z" type="float"/></accessor></technique_common></source><vertices')
    path.write_text(text.replace("<translate>10 0 0</translate>", flat).replace(
        "<vertices", normals).replace('source="#p"/></vertices>', 'source="#p"/>'
                                      '<input semantic="NORMAL" source="#n"/></vertices>'))
    (part,) = load_mesh(Mesh(str(path), submesh="left"))
    np.testing.assert_allclose(part.vertices, [(0, 0, 0.5), (1, 0, 0.5), (0, 2, 0.5)])
    np.testing.assert_allclose(part.normals, [(0, 0, 1)] * 3)


@pytest.mark.parametrize("there, gone, said", [
    ("<init_from>img<", "<init_from>jpg<", "image 'jpg', surface 'surface', texture 'sampler'"),
    ("<source>surface<", "<source>surfaces<", "surface 'surfaces', texture 'sampler'"),
    ('texture="sampler"', 'texture="other.png"', "texture 'other.png'"),
    ('url="#pictured"', 'url="#painting"', "effect 'painting', material 'm2'"),
    ('url="#pictured"', 'url="other.dae#pictured"', "effect 'other.dae#pictured', material 'm2'"),
    ('target="#m2"', 'target="#m3"', "material 'm3'"),
    ('id="img"', 'id="image"', "image 'img', surface 'surface', texture 'sampler'"),
    ('source="#t" offset', 'source="#u" offset', "source 'u'"),
    ('source="#p"/></vertices>', 'source="#p"/><input semantic="NORMAL" source="#n"/></vertices>',
     "source 'n'"),
    ('<node id="a" name="left">', '<node id="a" name="left"><instance_node url="#wheel"/>'
     '<instance_camera url="#eye"/>', "node 'wheel'"),
    ('<node id="a" name="left">', '<node id="a" name="left"><instance_geometry url="#cube"/>',
     "geometry 'cube'"),
    ('visual_scene url="#s"', 'visual_scene url="#scene"', "visual_scene 'scene'"),
    ("<library_effects>", '<library_effects><effect id="e"><profile_GLSL/></effect>', ""),
    ("<lambert>\n        <diffuse>", '<lambert>\n        <ambient><texture texture="x"/></ambient>'
     "<diffuse>", "texture 'x'"),
    ("</technique></profile_COMMON></effect>\n  </lib", "<extra><technique profile='F'><bump>"
     "<texture texture='x'/></bump></technique></extra></technique></profile_COMMON></effect>\n"
     "  </lib", "texture 'x'"),
])
def test_triangles_stay_whatever_a_collada_file_refers_to(tmp_path, caplog, there, gone, said):
    path = tmp_path / "dangling.dae"
    text = DAE.format(unit="1", up="Z_UP", image="picture.png")
    assert there in text
    path.write_text(text.replace(there, gone))
    (tmp_path / "picture.png").write_bytes(b"")
    left, right = load_mesh(Mesh(str(path)))
    assert len(left.faces) == len(right.faces) == 1
    assert caplog.messages == ([f"mesh {path}: it refers to what is not in it: {said}; drawn "
                                "without"] if said else [])
    assert left.material.diffuse == pytest.approx((0.2, 0.4, 0.6, 0.25))
    if "texture" in said and "x" not in said:  # neither black nor the missing picture
        assert right.material.texture is None and right.material.diffuse == (0.7, 0.7, 0.7, 1.0)


def test_a_collada_file_cannot_grow_by_its_entities(tmp_path):
    bomb = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "lol"}">' for n in range(10))
    for encoding in ("utf-8", "utf-16"):
        path = tmp_path / f"{encoding}.dae"
        path.write_text(f"<!DOCTYPE a [{bomb}]><COLLADA b='&e9;'>&e9;</COLLADA>", encoding)
        with pytest.raises(FormatError, match="it declares entities"):
            load_mesh(Mesh(str(path)))


def test_the_time_for_colladas_references_is_linear():
    effects = "".join(f"<effect id='e{n}'><profile_COMMON><technique><phong/></technique>"
                      "</profile_COMMON></effect>" for n in range(20_000))
    root = etree.fromstring(f"<COLLADA><image id='i'/>{effects}</COLLADA>")
    began = time.process_time()
    assert without_dangling(root) == []
    assert time.process_time() - began < 5  # 27 s, were the images listed for each effect
