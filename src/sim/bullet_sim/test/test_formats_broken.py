"""What is refused, what is mended, numbers at the edge of sense, texts that are no model at all.

Every model of formats_broken.yaml fails with the one line that it expects; those of
formats_mended.yaml load, and give it as their one error line.
"""

import logging
import math
import os
import subprocess
import sys
from pathlib import Path

import pybullet_data
import pytest
import yaml

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.loading import load_entity, load_model, load_world
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.xml_values import numbers

INERTIAL = """<inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"""


def sdf_shape(shape: str) -> str:
    return f"""<sdf version="1.6"><model name="m"><link name="l"><collision name="c"><geometry>
        {shape}</geometry></collision><visual name="v"><geometry>{shape}</geometry></visual></link>
        </model></sdf>"""


def urdf_shape(shape: str) -> str:
    return f"""<robot name="r"><link name="l">{INERTIAL}<collision><geometry>{shape}</geometry>
        </collision><visual><geometry>{shape}</geometry></visual></link></robot>"""


@pytest.mark.parametrize("text", [
    sdf_shape("<box><size>1 0 1</size></box>"),
    sdf_shape("<cylinder><radius>1</radius><length>0</length></cylinder>"),
    sdf_shape("<sphere><radius>0.0</radius></sphere>"),
    urdf_shape('<box size="1 1 0"/>'),
    urdf_shape('<cylinder radius="0" length="1"/>'),
    urdf_shape('<sphere radius="0"/>'),
])
def test_a_shape_without_volume_is_seen_but_collides_with_nothing(text, caplog):
    link = load_model(text, Resources()).links[0]
    assert link.collisions == ()
    assert len(link.visuals) == 1
    (record,) = caplog.records
    assert "link 'l'" in record.getMessage()
    assert "no volume to collide with, left out" in record.getMessage()


def test_infinite_limits_are_none_in_sdf():
    joint = load_model("""<sdf version="1.6"><model name="m"><link name="l"/>
        <joint name="j" type="prismatic"><parent>world</parent><child>l</child><axis><limit>
        <lower>-inf</lower><upper>inf</upper><effort>inf</effort><velocity>+inf</velocity></limit>
        </axis></joint></model></sdf>""", Resources()).joints[0]
    assert (joint.lower, joint.upper, joint.effort, joint.velocity) == (-1e16, 1e16, -1, -1)


def test_infinite_limits_are_none_in_urdf():
    joint = load_model(f"""<robot name="r"><link name="a">{INERTIAL}</link>
        <link name="b">{INERTIAL}</link><joint name="j" type="prismatic"><parent link="a"/>
        <child link="b"/><limit lower="-inf" upper="2" effort="inf" velocity="1"/></joint></robot>
        """, Resources()).joints[0]
    assert (joint.lower, joint.upper, joint.effort, joint.velocity) == (-1e16, 2, -1, 1)


def test_products_of_inertia_and_mesh_scales_may_be_negative(tmp_path):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    link = load_model(f"""<sdf version="1.6"><model name="m"><link name="l">
        <inertial><inertia><ixy>-0.1</ixy></inertia></inertial>
        <visual name="v"><geometry><mesh><uri>{tmp_path}/m.obj</uri><scale>1 -1 1</scale></mesh>
        </geometry></visual></link></model></sdf>""", Resources()).links[0]
    assert link.inertial.inertia[1] == -0.1
    assert link.visuals[0].geometry.scale == (1, -1, 1)
    assert all(math.isfinite(value) for value in link.inertial.inertia)


@pytest.mark.parametrize("text", [
    """<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0"
    iyy="1" iyz="0" izz="1"/></inertial><collision><geometry><sphere radius="1"/></geometry>
    </collision></link><gazebo reference="a"><mu1>-1</mu1></gazebo></robot>""",
    """<sdf version="1.6"><model name="m"><link name="l"><collision name="c"><geometry><sphere/>
    </geometry><surface><friction><ode><mu>-1</mu></ode></friction></surface></collision></link>
    </model></sdf>""",
])
def test_a_friction_below_zero_is_without_limit(text):
    surface = load_model(text, Resources()).links[0].collisions[0].surface
    assert surface.mu > 1000
    assert surface.mu2 == 1.0


@pytest.mark.parametrize("load", [load_model, load_entity])
@pytest.mark.parametrize("text, reason", [
    ("hello", "the text is not well-formed XML: syntax error at line 1, column 1"),
    ("", "the text is empty: there is no XML in it"),
    ("<robot name='r'>\n <link></robot>",
     "the text is not well-formed XML: mismatched tag at line 2, column 10"),
    ("\n<sdf version='1.6'>\n<model name/></sdf>",
     "the text is not well-formed XML: not well-formed (invalid token) at line 3, column 12"),
    ("<sdf>\n<model name=m></sdf>", "the text is not well-formed XML: mismatched tag at line 2, "
     'column 19; line 2: write name="..." with quotes'),
])
def test_what_is_no_xml_gets_the_spawn_services_sentence(load, text, reason):
    with pytest.raises(FormatError) as raised:
        load(text, Resources())
    assert str(raised.value) == (
        "GazeboRosApiPlugin SpawnModel Failure: input model_xml not SDF or URDF, or cannot be "
        f"converted to Gazebo compatible format. ({reason})")


def test_the_xacro_command_does_not_wait_for_the_model_readers():
    code = "import sys, bullet_sim.formats.xacro.files; sys.exit('numpy' in sys.modules)"
    env = {"PYTHONPATH": os.pathsep.join(sys.path)}
    assert subprocess.run([sys.executable, "-c", code], env=env, check=False).returncode == 0


def test_hexadecimal_numbers(caplog):
    link = load_model("""<sdf version="1.6"><model name="m"><link name="l">
      <inertial><mass>0x10</mass></inertial><collision name="c"><geometry><sphere>
      <radius>0X1p-1</radius></sphere></geometry><surface><contact><collide_bitmask>0x0f
      </collide_bitmask></contact></surface></collision></link></model></sdf>""",
                      Resources()).links[0]
    (collision,) = link.collisions
    assert (link.inertial.mass, collision.geometry.radius) == (16.0, 0.5)
    assert collision.surface.collide_bitmask == 15
    assert not caplog.records


STATIC = """<sdf version="1.6"><model name="m"><static>{}</static><link name="l"><inertial>
  <pose>nan nan nan 0 0 0</pose><mass>inf</mass><inertia><ixx>nan</ixx><iyy>-nan</iyy>
  <izz>-inf</izz><ixy>0.5</ixy></inertia></inertial></link>{}</model></sdf>"""


def test_inertia_without_end_is_silent_in_what_stands_still(caplog, tmp_path):
    nested = STATIC.format(0, "").partition("<static>")[2].partition("</static>")[2]
    inner = f"<model name='n'>{nested.removesuffix('</sdf>')}"
    model = load_model(STATIC.format("true", inner), Resources())
    assert [link.inertial.inertia[1] for link in model.links] == [0.5, 0.5]
    (tmp_path / "model.sdf").write_text(STATIC.format("false", ""))
    world = tmp_path / "w.world"
    world.write_text("<sdf version='1.6'><world name='w'><include><static>1</static>"
                     f"<uri>{tmp_path}/model.sdf</uri></include></world></sdf>")
    assert load_world(world, Resources()).models[0].static
    assert not caplog.records
    load_model(STATIC.format("false", ""), Resources())
    assert len(caplog.records) == 5


@pytest.mark.parametrize("word", ["0x1p99999", "0x" + "f" * 300])
def test_a_hexadecimal_number_too_large_for_any_is_no_number(word):
    with pytest.raises(FormatError):
        numbers(word, 1, "a mass")


FOREIGN = [file for file in Path(pybullet_data.getDataPath()).rglob("*.urdf")
           if "random_urdfs" not in file.parts]
HERE = Path(__file__).parent
BROKEN, MENDED = (yaml.safe_load((HERE / name).read_text(encoding="utf-8"))
                  for name in ("formats_broken.yaml", "formats_mended.yaml"))


@pytest.mark.parametrize("name", BROKEN)
def test_broken_model_says_what_is_wrong(name):
    with pytest.raises(FormatError) as raised:
        load_model(BROKEN[name]["text"], Resources())
    assert str(raised.value).endswith(BROKEN[name]["expect"])
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", MENDED)
def test_one_wrong_thing_is_one_error_line_and_the_rest_loads(name, caplog):
    assert load_model(MENDED[name]["text"], Resources()).links
    said = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert said == [MENDED[name]["expect"]]


def test_there_are_such_models():
    assert len(BROKEN) > 20 and len(MENDED) > 30


def test_files_of_other_people_load_or_say_why_not():
    loaded = 0
    resources = Resources(find_package=lambda package: f"/nonexistent/{package}")
    for file in FOREIGN:
        try:
            loaded += bool(load_model(file.read_text(errors="replace"), resources).links)
        except SimulationError as error:
            assert "\n" not in str(error)
    assert loaded > 0.7 * len(FOREIGN) > 35
