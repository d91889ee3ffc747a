"""Robots, worlds and launch files as texts for the tests of check."""

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><box size="1 1 1"/></geometry></visual></link>{}</robot>"""
WORLD = """<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>
  {}</world></sdf>"""
LAUNCH = """<launch><arg name="who" default="r"/>
  <param name="robot_description" textfile="$(dirname)/robot.urdf"/>
  <node name="s" pkg="gazebo_ros" type="spawn_model" args="-urdf -param {} -model $(arg who)"/>
  <node name="n" pkg="{}" type="{}"/></launch>"""
JOINTED = ROBOT.format("""<link name="wheel"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="j" type="continuous"><parent link="base"/><child link="wheel"/></joint>{}""")
DRIVE = """<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
  <{tag}>j</{tag}><rightJoint>j</rightJoint><odometryTopic>odom</odometryTopic></plugin></gazebo>"""
