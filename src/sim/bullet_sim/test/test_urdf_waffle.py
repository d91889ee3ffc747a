"""URDF by Gazebo's rules, on a robot with the waffle's links, masses and plugins."""

import math

import pytest

from bullet_sim.description import Box, Cylinder, Inertial
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources
from bullet_sim.formats.urdf.lumping import combined
from bullet_sim.pose import Pose

INERTIA = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'


def wheel(side: str, y: float) -> str:
    return f"""
    <link name="wheel_{side}_link">
      <inertial><mass value="0.02849894"/>{INERTIA}</inertial>
      <visual><origin rpy="1.57 0 0"/><geometry><cylinder radius="0.033" length="0.018"/>
      </geometry></visual>
      <collision><geometry><cylinder radius="0.033" length="0.018"/></geometry></collision>
    </link>
    <joint name="wheel_{side}_joint" type="continuous">
      <parent link="base_link"/><child link="wheel_{side}_link"/>
      <origin xyz="0 {y} 0.023" rpy="-1.57 0 0"/><axis xyz="0 0 1"/>
    </joint>
    <gazebo reference="wheel_{side}_link">
      <mu1>0.1</mu1><mu2>0.1</mu2><kp>500000.0</kp><kd>10.0</kd>
      <minDepth>0.001</minDepth><maxVel>0.1</maxVel><fdir1>1 0 0</fdir1>
      <material>Gazebo/FlatBlack</material>
    </gazebo>"""


def caster(side: str, y: float) -> str:
    return f"""
    <link name="caster_back_{side}_link">
      <inertial><mass value="0.005"/>{INERTIA}</inertial>
      <collision><origin xyz="0 0.001 0"/><geometry><box size="0.030 0.009 0.020"/></geometry>
      </collision>
    </link>
    <joint name="caster_back_{side}_joint" type="fixed">
      <parent link="base_link"/><child link="caster_back_{side}_link"/>
      <origin xyz="-0.177 {y} -0.004" rpy="-1.57 0 0"/>
    </joint>
    <gazebo reference="caster_back_{side}_link"><mu1>0.1</mu1><kp>1000000</kp></gazebo>
    <gazebo reference="caster_back_{side}_link"><mu2>0.2</mu2></gazebo>"""


def fixed(name: str, parent: str, child: str, xyz: str, rpy: str = "0 0 0") -> str:
    return f"""<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/>
    <origin xyz="{xyz}" rpy="{rpy}"/></joint>"""


WAFFLE = f"""<?xml version="1.0"?>
<robot name="turtlebot3_waffle">
  <material name="red"><color rgba="0.8 0 0 1"/></material>
  <link name="base_footprint"/>
  {fixed("base_joint", "base_footprint", "base_link", "0 0 0.010")}
  <link name="base_link">
    <inertial><mass value="1.3729096"/>{INERTIA}</inertial>
    <visual><geometry><box size="0.266 0.266 0.094"/></geometry><material name="red"/></visual>
    <collision><origin xyz="-0.064 0 0.047"/><geometry><box size="0.266 0.266 0.094"/></geometry>
    </collision>
  </link>
  {wheel("left", 0.144)} {wheel("right", -0.144)} {caster("left", 0.064)} {caster("right", -0.064)}
  <link name="imu_link"/> {fixed("imu_joint", "base_link", "imu_link", "0 0 0.068")}
  <link name="base_scan">
    <inertial><mass value="0.114"/>{INERTIA}</inertial>
    <collision><origin xyz="0.015 0 -0.0065"/><geometry><cylinder radius="0.055" length="0.0315"/>
    </geometry></collision>
  </link>
  {fixed("scan_joint", "base_link", "base_scan", "-0.064 0 0.122")}
  <link name="camera_link"/>
  {fixed("camera_joint", "base_link", "camera_link", "0.064 -0.065 0.094")}
  <link name="camera_rgb_frame"/>
  {fixed("camera_rgb_joint", "camera_link", "camera_rgb_frame", "0.005 0.018 0.013")}
  <link name="camera_rgb_optical_frame"/>
  {fixed("camera_rgb_optical_joint", "camera_rgb_frame", "camera_rgb_optical_frame",
         "0 0 0", "-1.57 0 -1.57")}
  <gazebo reference="base_link"><material>Gazebo/DarkGrey</material></gazebo>
  <gazebo><plugin name="turtlebot3_waffle_controller" filename="libgazebo_ros_diff_drive.so">
    <robotBaseFrame>base_footprint</robotBaseFrame></plugin></gazebo>
  <gazebo><plugin name="imu_plugin" filename="libgazebo_ros_imu.so">
    <bodyName>imu_link</bodyName><frameName>imu_link</frameName><topicName>imu</topicName>
    </plugin></gazebo>
  <gazebo reference="imu_link"><sensor type="imu" name="imu"><always_on>true</always_on></sensor>
  </gazebo>
  <gazebo reference="base_scan"><sensor type="ray" name="lds_lfcd_sensor">
    <pose>0 0 0.001 0 0 0</pose><update_rate>5</update_rate>
    <ray><scan><horizontal><samples>360</samples><resolution>1</resolution>
      <min_angle>0.0</min_angle><max_angle>6.28319</max_angle></horizontal></scan>
      <range><min>0.120</min><max>3.5</max><resolution>0.015</resolution></range>
      <noise><type>gaussian</type><mean>0.0</mean><stddev>0.01</stddev></noise></ray>
    <plugin name="laser" filename="libgazebo_ros_laser.so"><frameName>base_scan</frameName></plugin>
  </sensor></gazebo>
  <gazebo reference="camera_rgb_frame"><sensor type="depth" name="realsense_R200">
    <camera name="realsense_R200"><horizontal_fov>1.3439</horizontal_fov>
      <image><width>1920</width><height>1080</height><format>R8G8B8</format></image>
      <clip><near>0.03</near><far>100</far></clip></camera>
    <plugin name="camera_controller" filename="libgazebo_ros_openni_kinect.so">
      <frameName>camera_rgb_optical_frame</frameName></plugin>
  </sensor></gazebo>
</robot>
"""


@pytest.fixture(scope="module")
def waffle():
    return load_model(WAFFLE, Resources(), name="waffle")


def by_name(things) -> dict:
    return {thing.name: thing for thing in things}


def test_only_three_links_of_the_waffle_remain(waffle):
    # conforms: urdf robot, urdf robot/link, urdf robot/joint, urdf robot/gazebo
    assert waffle.name == "waffle"
    assert [link.name for link in waffle.links] == [
        "base_footprint", "wheel_left_link", "wheel_right_link"]
    assert [joint.name for joint in waffle.joints] == ["wheel_left_joint", "wheel_right_joint"]


def test_wheel_joint_hangs_on_the_surviving_link(waffle):
    joint = by_name(waffle.joints)["wheel_left_joint"]
    assert (joint.type, joint.parent, joint.child) == (
        "continuous", "base_footprint", "wheel_left_link")
    assert joint.axis == (0, 0, 1)
    assert joint.upper == 1e16
    pose = by_name(waffle.links)["wheel_left_link"].pose
    assert pose.position == pytest.approx((0, 0.144, 0.033))
    assert pose.rpy() == pytest.approx((-1.57, 0, 0))


def test_lumped_mass_is_the_sum(waffle):
    # conforms: URDF conversion/fixed joints
    base = waffle.links[0].inertial
    assert base.mass == pytest.approx(1.3729096 + 0.114 + 2 * 0.005)


def test_lumped_collisions_have_sdformats_names(waffle):
    names = [collision.name for collision in waffle.links[0].collisions]
    lump = "base_footprint_fixed_joint_lump__"
    assert names == [
        f"{lump}base_link_collision",
        f"{lump}caster_back_left_link_collision_1",
        f"{lump}caster_back_right_link_collision_2",
        f"{lump}base_scan_collision_3",
    ]
    wheel_left = by_name(waffle.links)["wheel_left_link"]
    assert wheel_left.collisions[0].name == "wheel_left_link_collision"


def test_lumped_shapes_keep_their_place_and_surface(waffle):
    # conforms: urdf gazebo@link
    base, caster_left, _, scan = waffle.links[0].collisions
    assert base.pose.position == pytest.approx((-0.064, 0, 0.057))
    assert base.geometry == Box((0.266, 0.266, 0.094))
    assert base.surface.mu == 1.0
    surface = caster_left.surface
    assert (surface.mu, surface.mu2, surface.kp) == (0.1, 0.2, 1e6)
    assert scan.geometry == Cylinder(0.055, 0.0315)
    assert scan.pose.position == pytest.approx((-0.049, 0, 0.1255))


def test_sensors_move_with_their_links(waffle):
    sensors = by_name(waffle.links[0].sensors)
    assert sorted(sensors) == ["imu", "lds_lfcd_sensor", "realsense_R200"]
    assert sensors["lds_lfcd_sensor"].pose.position == pytest.approx((-0.064, 0, 0.133))
    assert sensors["realsense_R200"].pose.position == pytest.approx((0.069, -0.047, 0.117))
    camera = sensors["realsense_R200"].cameras[0]
    assert (camera.width, camera.height, camera.horizontal_fov, camera.near) == (
        1920, 1080, 1.3439, 0.03)
    ray = sensors["lds_lfcd_sensor"].ray
    assert (ray.samples, ray.max_angle, ray.range_min) == (360, 6.28319, 0.12)
    assert ray.noise.stddev == 0.01
    assert sensors["lds_lfcd_sensor"].update_rate == 5


def test_model_plugins_follow_lumping_and_sensor_plugins_do_not(waffle):
    imu = by_name(waffle.plugins)["imu_plugin"].element
    assert imu.findtext("bodyName") == imu.findtext("frameName") == "base_footprint"
    offset = [float(word) for word in imu.findtext("xyzOffset").split()]
    assert offset == pytest.approx([0, 0, 0.078])
    laser = by_name(waffle.links[0].sensors)["lds_lfcd_sensor"].plugins[0]
    assert laser.element.findtext("frameName") == "base_scan"
    drive = by_name(waffle.plugins)["turtlebot3_waffle_controller"]
    assert drive.filename == "libgazebo_ros_diff_drive.so"
    assert drive.element.find("xyzOffset") is None


def test_lumped_links_are_remembered_with_their_place(waffle):
    survivor, pose = waffle.lumped["camera_rgb_optical_frame"]
    assert survivor == "base_footprint"
    assert pose.position == pytest.approx((0.069, -0.047, 0.117))
    assert "base_footprint" not in waffle.lumped


def test_two_boxes_lumped_have_the_inertia_of_the_whole():
    def brick(length_x):  # of mass 1 per metre, 0.2 by 0.3 across
        mass, b, c = length_x, 0.2, 0.3
        return Inertial(mass, Pose(), (mass * (b * b + c * c) / 12, 0, 0,
                                       mass * (length_x**2 + c * c) / 12, 0,
                                       mass * (length_x**2 + b * b) / 12))
    quarter_turn = Pose.from_xyz_rpy((0.75, 0, 0), (0, 0, math.pi / 2))
    turned = Inertial(0.5, Pose.from_xyz_rpy((0, 0, 0), (0, 0, -math.pi / 2)), brick(0.5).inertia)
    whole = combined(brick(1.0), turned, quarter_turn)
    assert whole.mass == pytest.approx(1.5)
    assert whole.pose.position == pytest.approx((0.25, 0, 0))
    assert whole.inertia == pytest.approx(brick(1.5).inertia)
