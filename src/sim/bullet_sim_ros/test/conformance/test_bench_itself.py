"""The bench that the conformance tests stand on."""

import logging

import pytest
import rospy
from geometry_msgs.msg import Twist

from bullet_sim.pose import Pose

ROBOT = """<model name="box">
  <link name="body"><inertial><mass>1</mass></inertial>
    <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision></link>
  <plugin name="truth" filename="libgazebo_ros_p3d.so">
    <bodyName>body</bodyName><topicName>truth</topicName><updateRate>50</updateRate></plugin>
</model>"""


def test_a_model_publishes_while_somebody_listens_and_no_longer_than_it_lives(bench):
    bench.spawn(ROBOT, namespace="/r1")
    assert "/r1/truth" in bench.advertised()
    bench.run(0.1)
    poses = bench.listen("/r1/truth")
    assert not poses
    bench.run(1.0)
    assert len(poses) == 50
    assert poses[-1].header.stamp == rospy.Time.from_sec(1.1)
    bench.delete("box")
    assert "/r1/truth" not in bench.advertised()


def test_services_answer_and_fail_as_over_the_wire(bench):
    bench.spawn(ROBOT)
    answer = bench.call("/gazebo/get_model_state", model_name="box")
    assert (answer.success, answer.status_message) == (True, "GetModelState: got properties")
    with pytest.raises(rospy.ServiceException, match="entity format is invalid"):
        bench.call("/gazebo/spawn_urdf_model", model_name="x", model_xml="<sdf/>")


def test_what_is_sent_reaches_the_plugins(bench):
    model = bench.spawn("""<model name="car"><link name="base"/><plugin name="d"
      filename="libgazebo_ros_planar_move.so"/></model>""", Pose((0, 0, 5)))
    assert bench.subscribed()["/cmd_vel"] is Twist
    command = Twist()
    command.linear.x = 0.5
    bench.send("/cmd_vel", command)
    bench.run(0.1)
    assert model.twist.linear[0] == pytest.approx(0.5, abs=0.01)


def test_pictures_are_drawn(bench):
    bench.spawn("""<model name="eye"><static>true</static><link name="l"><sensor name="s"
      type="camera"><update_rate>10</update_rate><camera><image><width>32</width>
      <height>24</height></image></camera><plugin name="p" filename="libgazebo_ros_camera.so">
      <cameraName>eye</cameraName></plugin></sensor></link></model>""")
    images = bench.listen("/eye/image_raw")
    bench.run(0.55)
    assert len(images) == 5
    assert (images[0].width, images[0].height, images[0].encoding) == (32, 24, "rgb8")


def test_what_upstream_says_when_its_services_are_there(make_bench, caplog):
    with caplog.at_level(logging.INFO):
        make_bench()
    said = [record.getMessage() for record in caplog.records if record.name == "rosout"]
    assert said == ["Physics dynamic reconfigure ready.", "Finished loading Gazebo ROS API Plugin."]
