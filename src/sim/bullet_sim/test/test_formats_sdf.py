"""SDF models: defaults, frames, joint axes of old and new files, nesting."""

import math

import pytest

from bullet_sim.description import Box, Inertial, Plane, Surface
from bullet_sim.errors import ResourceNotFound, SimulationError
from bullet_sim.formats.loading import load_entity, load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.source import NEWEST_SDF, sdf_version

NO_FILES = Resources()


def sdf(body: str, version: str = "1.6") -> str:
    return f'<?xml version="1.0"?><sdf version="{version}"><model name="m">{body}</model></sdf>'


def read(body: str, version: str = "1.6"):
    return load_model(sdf(body, version), NO_FILES)


def test_an_empty_link_has_sdfs_defaults():
    model = load_model(sdf('<link name="l"/>'), NO_FILES, name="other")
    assert (model.name, model.static, model.self_collide) == ("other", False, False)
    link = model.links[0]
    assert link.inertial == Inertial(1.0, inertia=(1, 0, 0, 1, 0, 1))
    assert (link.gravity, link.kinematic, link.linear_damping) == (True, False, 0)


@pytest.mark.parametrize("text, version", [
    ("1.4", (1, 4)), (" 1.10 ", (1, 10)), ("1", (1, 0)), ("", NEWEST_SDF), ("new", NEWEST_SDF)])
def test_versions_of_sdf(text, version):
    assert sdf_version(text) == version


def test_shapes_and_surfaces():
    link = read("""<static>1</static><link name="l">
      <collision name="c"><geometry><box><size>1 2 3</size></box></geometry>
        <surface><friction><ode><mu>0.5</mu><fdir1>1 0 0</fdir1></ode></friction>
          <contact><ode><kp>1e5</kp><min_depth>0.001</min_depth></ode></contact>
          <bounce><restitution_coefficient>0.9</restitution_coefficient><threshold>1</threshold>
          </bounce></surface>
          </collision>
      <collision name="floor"><geometry><plane><size>4 5</size></plane></geometry></collision>
      <visual name="v"><pose>1 -0
          2 0 0 0</pose><transparency>0.25</transparency><cast_shadows>0</cast_shadows>
        <geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link>""").links[0]
    assert link.collisions[0].geometry == Box((1, 2, 3))
    assert link.collisions[0].surface == Surface(
        mu=0.5, fdir1=(1, 0, 0), kp=1e5, min_depth=0.001, restitution=0.9)
    assert link.collisions[1].geometry == Plane((0, 0, 1), (4, 5))
    assert link.collisions[1].surface == Surface()
    visual = link.visuals[0]
    assert visual.pose.position == (1, 0, 2)
    assert (visual.transparency, visual.cast_shadows, visual.material) == (0.25, False, None)


ARM = """<link name="a"/><link name="b"><pose>1 0 0 0 0 {yaw}</pose></link>
    <joint name="j" type="revolute"><parent>a</parent><child>b</child><pose>0 0 0 {roll} 0 0</pose>
    <axis><xyz>1 0 0</xyz>{more}<limit><lower>-1</lower><upper>1</upper></limit></axis></joint>"""


@pytest.mark.parametrize("version, more, expected", [
    ("1.4", "", (0, -1, 0)),  # the model's x, seen from a link turned by a quarter
    ("1.5", "", (1, 0, 0)),
    ("1.6", "<use_parent_model_frame>1</use_parent_model_frame>", (0, -1, 0)),
])
def test_axis_is_brought_into_the_joint_frame(version, more, expected):
    joint = read(ARM.format(yaw=math.pi / 2, roll=0, more=more), version).joints[0]
    assert joint.axis == pytest.approx(expected, abs=1e-12)
    assert (joint.lower, joint.upper, joint.effort) == (-1, 1, -1)


def test_an_axis_has_length_1():
    arm = ARM.format(yaw=0, roll=0, more="").replace("<xyz>1 0 0", "<xyz>3 0 -4")
    assert read(arm).joints[0].axis == pytest.approx((0.6, 0.0, -0.8))


def test_the_joints_own_turn_counts_for_a_model_frame_axis():
    arm = ARM.format(yaw=0, roll=math.pi / 2, more="").replace("<xyz>1 0 0", "<xyz>0 0 2")
    joint = read(arm, "1.4").joints[0]
    assert joint.axis == pytest.approx((0, 1, 0), abs=1e-12)
    assert joint.pose.rpy() == pytest.approx((math.pi / 2, 0, 0))


def test_relative_to_chains():
    model = read("""<frame name="f" attached_to="a"><pose>0 0 1 0 0 0</pose></frame>
        <link name="a"><pose>1 0 0 0 0 1.5707963267948966</pose></link>
        <link name="b"><pose relative_to="f">1 0 0 0 0 0</pose></link>
        <joint name="j" type="fixed"><pose relative_to="a"/><parent>a</parent><child>b</child>
        </joint>
        """, "1.7")
    assert model.links[1].pose.position == pytest.approx((1, 1, 1))
    assert model.joints[0].pose.position == pytest.approx((-1, 0, -1))  # where a is, seen from b


def test_a_circle_of_frames_is_a_warning(caplog):
    read("""<link name="a"><pose relative_to="b">0 0 0 0 0 0</pose></link>
        <link name="b"><pose relative_to="a">0 0 0 0 0 0</pose></link>""", "1.7")
    assert "refers to itself" in caplog.text


def test_nested_model_is_scoped_and_placed():
    model = read("""<link name="base"/>
      <model name="arm"><pose>1 0 0 0 0 1.5707963267948966</pose>
        <link name="upper"><pose>1 0 0 0 0 0</pose></link><link name="lower"/>
        <joint name="elbow" type="revolute"><parent>upper</parent><child>lower</child></joint>
        <plugin name="p" filename="f"><joint>elbow</joint></plugin></model>
      <joint name="mount" type="fixed"><parent>base</parent><child>arm::upper</child></joint>""")
    assert [link.name for link in model.links] == ["base", "arm::upper", "arm::lower"]
    assert model.links[1].pose.position == pytest.approx((1, 1, 0))
    assert {joint.name: joint.child for joint in model.joints} == {
        "mount": "arm::upper", "arm::elbow": "arm::lower"}
    assert model.child_models == ("arm",)
    assert model.plugins[0].element.findtext("joint") == "arm::elbow"


def test_sensor_defaults():
    sensor = read("""<link name="l"><sensor name="s" type="camera"><camera/></sensor>
        <sensor name="r" type="ray"><ray/></sensor></link>""").links[0].sensors
    camera = sensor[0].cameras[0]
    assert (camera.width, camera.height, camera.horizontal_fov) == (320, 240, 1.047)
    assert (camera.near, camera.far, camera.noise.type) == (0.1, 100, "none")
    assert (sensor[1].ray.samples, sensor[1].ray.vertical_samples) == (640, 1)


def test_multicamera_keeps_all_cameras():
    sensor = read("""<link name="l"><sensor name="s" type="multicamera">
        <camera name="left"><image><width>64</width><height>48</height></image></camera>
        <camera name="right"/></sensor></link>""").links[0].sensors[0]
    assert [camera.width for camera in sensor.cameras] == [64, 320]


def test_unknown_geometry_is_one_warning(caplog):
    model = read("""<link name="l"><visual name="v"><geometry><capsule/></geometry>
    </visual>
        </link>""")
    assert model.links[0].visuals == ()
    assert len(caplog.records) == 1
    assert "<capsule> is not supported" in caplog.text


def test_gazebo_root_and_light_root():
    assert load_model('<gazebo version="1.2"><model name="m"><link name="l"/></model></gazebo>',
                      NO_FILES).name == "m"
    light = load_entity("""<sdf version="1.6"><light name="lamp" type="spot">
        <diffuse>1 0 0 1</diffuse></light></sdf>""", NO_FILES)
    assert (light.name, light.type, light.range) == ("lamp", "spot", 10)
    assert light.diffuse == (1, 0, 0, 1)
    assert load_entity(sdf('<link name="l"/>'), NO_FILES).links[0].name == "l"
    lamp = '<light name="lamp" type="spot"/>'
    for other in ('<sdf version="1.6"/>', f"<robot>{lamp}</robot>",
                  f'<sdf version="1.6"><include><uri>model://x</uri></include>{lamp}</sdf>'):
        with pytest.raises(SimulationError):
            load_entity(other, NO_FILES)


def test_database_text_brings_in_the_included_model():
    text = """<sdf version="1.4"><world name="w"><include><uri>model://ground_plane</uri>
        <name>floor</name><pose>0 0 1 0 0 0</pose></include></world></sdf>"""
    model = load_model(text, Resources.from_environment({"HOME": "/nonexistent"}))
    assert (model.name, model.static, model.pose.position) == ("floor", True, (0, 0, 1))


def test_database_text_of_a_missing_model_is_an_error():
    text = """<sdf version="1.4"><world name="w">
        <include><uri>model://gone</uri></include></world></sdf>"""
    with pytest.raises(ResourceNotFound, match=r"^model://gone not found"):
        load_model(text, NO_FILES)


def test_a_folder_is_no_mesh(tmp_path, caplog):
    model = read(f"""<link name="l"><visual name="v"><geometry><mesh><uri>file://{tmp_path}</uri></mesh>
        </geometry></visual></link>""")
    assert model.links[0].visuals == ()
    assert f"file 'file://{tmp_path}' not found" in caplog.text


def test_prefixes_nobody_declared_and_blanks_before_the_declaration_are_read():
    text = sdf('<link name="l"/><xacro:leftover a="1"/>')
    text = text.replace('"1.0"?', '"1.0" encoding="GB2312"?')
    assert load_model(f"\n  {text}", NO_FILES).links[0].name == "l"
