"""Sensors without `<camera>`, `<ray>`, `<imu>` or `<contact>`: sdformat gives its defaults."""

import math

import pytest
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, PointCloud2

SENSOR = """<sdf version="1.6"><model name="bare"><static>1</static><link name="link">
  <collision name="c"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>
  <sensor name="s" type="{}"><update_rate>20</update_rate>{}
    <plugin name="p" filename="{}">{}</plugin></sensor></link></model></sdf>"""
NAMES = "<cameraName>eye</cameraName><frameName>eye</frameName>"
PIXELS_DEPTH = (NAMES + "<imageTopicName>image_raw</imageTopicName>"
                "<cameraInfoTopicName>camera_info</cameraInfoTopicName>"
                "<depthImageTopicName>depth</depthImageTopicName>"
                "<pointCloudTopicName>points</pointCloudTopicName>")


def heard(bench, kind, plugin, tags, *topics, inside=""):
    bench.spawn(SENSOR.format(kind, inside, plugin, tags))
    messages = [bench.listen(topic) for topic in topics]
    bench.run(0.3)
    assert all(messages), dict(zip(topics, map(len, messages), strict=True))
    return [each[-1] for each in messages]


@pytest.mark.parametrize("kind, plugin", [
    ("camera", "libgazebo_ros_camera.so"), ("depth", "libgazebo_ros_depth_camera.so"),
    ("depth", "libgazebo_ros_openni_kinect.so")])
def test_a_camera_has_the_default_picture(bench, caplog, kind, plugin):
    bench.spawn(SENSOR.format(kind, "", plugin, PIXELS_DEPTH))
    made = bench.advertised()
    topics = [topic for topic, type_ in made.items() if type_ in (Image, CameraInfo)]
    messages = [bench.listen(topic) for topic in topics]
    bench.run(0.3)
    assert {(each[-1].width, each[-1].height) for each in messages} == {(320, 240)}
    told = [each[-1].K[0] for each in messages if isinstance(each[-1], CameraInfo)]
    assert told == pytest.approx([160 / math.tan(1.047 / 2)] * len(told)) and told
    assert not [record for record in caplog.records if "<camera>" in record.getMessage()]
    assert kind == "camera" or PointCloud2 in made.values()


@pytest.mark.parametrize("kind, plugin", [
    ("ray", "libgazebo_ros_laser.so"), ("gpu_ray", "libgazebo_ros_gpu_laser.so")])
@pytest.mark.parametrize("inside", ["", "<ray/>", "<ray><range><max>5</max></range></ray>"])
def test_a_laser_has_640_rays_straight_ahead(bench, kind, plugin, inside):
    (scan,) = heard(bench, kind, plugin, "<topicName>/scan</topicName>", "/scan", inside=inside)
    assert isinstance(scan, LaserScan) and len(scan.ranges) == 640
    assert (scan.angle_min, scan.angle_max, scan.range_min) == (0, 0, 0)
    assert scan.range_max == (5 if "max" in inside else 0)


def test_an_imu_has_no_noise(bench):
    bench.spawn(SENSOR.format("imu", "", "libgazebo_ros_imu_sensor.so",
                              "<frameName>imu</frameName><updateRateHZ>20</updateRateHZ>"))
    (topic,) = [topic for topic, type_ in bench.advertised().items() if type_ is Imu]
    readings = bench.listen(topic)
    bench.run(0.3)
    assert readings and readings[-1].angular_velocity.x == 0


def test_a_contact_sensor_feels_all_of_its_link(bench):
    (state,) = heard(bench, "contact", "libgazebo_ros_bumper.so",
                     "<bumperTopicName>/touch</bumperTopicName>", "/touch")
    assert state.states == []
