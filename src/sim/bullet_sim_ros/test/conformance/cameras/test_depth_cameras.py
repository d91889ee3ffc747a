"""Kinects and depth cameras: depth, points, both infos."""

import math

import numpy as np
import pytest
import rospy
from camera_models import SMALL, WALL, eye
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

KINECT, DEPTH = "libgazebo_ros_openni_kinect.so", "libgazebo_ros_depth_camera.so"
CLIP = "<clip><near>0.05</near><far>50</far></clip>"
# 1.5 m ahead, 7 m ahead and nothing: left third, right third, middle; all red.
STEPS = "".join(f"""<model name="s{x}"><static>true</static><pose>{x} {y} 0 0 0 0</pose>
  <link name="l"><visual name="v"><geometry><box><size>0.001 {w} 9</size></box></geometry>
  <material><ambient>0 0 0 1</ambient><diffuse>0 0 0 1</diffuse><emissive>1 0 0 1</emissive>
  </material></visual></link></model>""" for x, y, w in ((1.5, 0.8, 1.0), (7, -3.0, 4.0)))


def kinect(bench, tags="", plugin=KINECT, **options):
    bench.spawn(eye(plugin, tags, SMALL + CLIP, "depth", **options))


def steps(bench):
    for model in STEPS.split("</model>")[:-1]:
        bench.spawn(model + "</model>")


def one(bench, topic, seconds=0.15):
    messages = bench.listen(topic)
    bench.run(seconds)
    first = messages[0] if messages else None
    bench.listen(topic, 0)
    return first


def depth_of(msg):
    return np.frombuffer(msg.data, {"32FC1": np.float32, "16UC1": np.uint16}[msg.encoding]
                         ).reshape(msg.height, msg.width)


def points_of(msg):
    kind = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "u1", 4)])
    return np.frombuffer(msg.data, kind).reshape(msg.height, msg.width)


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_topics_and_their_defaults(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so, libgazebo_ros_depth_camera.so
    # conforms: libgazebo_ros_openni_kinect.so/cameraName, libgazebo_ros_depth_camera.so/cameraName
    # conforms: libgazebo_ros_openni_kinect.so/robotNamespace
    # conforms: libgazebo_ros_depth_camera.so/robotNamespace
    kinect(bench, "<robotNamespace>r</robotNamespace>", plugin)
    made = bench.advertised()
    assert {"/r/eye/image_raw": Image, "/r/eye/camera_info": CameraInfo,
            "/r/eye/depth/image_raw": Image, "/r/eye/depth/camera_info": CameraInfo,
            "/r/eye/points": PointCloud2}.items() <= made.items()
    assert "/r/eye/set_camera_info" in bench.graph.services
    assert "/r/eye/set_parameters" in bench.graph.services


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_topics_and_frame_as_named(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so/imageTopicName
    # conforms: libgazebo_ros_openni_kinect.so/cameraInfoTopicName
    # conforms: libgazebo_ros_openni_kinect.so/depthImageTopicName
    # conforms: libgazebo_ros_openni_kinect.so/depthImageCameraInfoTopicName
    # conforms: libgazebo_ros_openni_kinect.so/pointCloudTopicName
    # conforms: libgazebo_ros_openni_kinect.so/frameName
    # conforms: libgazebo_ros_depth_camera.so/imageTopicName
    # conforms: libgazebo_ros_depth_camera.so/cameraInfoTopicName
    # conforms: libgazebo_ros_depth_camera.so/depthImageTopicName
    # conforms: libgazebo_ros_depth_camera.so/depthImageCameraInfoTopicName
    # conforms: libgazebo_ros_depth_camera.so/pointCloudTopicName
    # conforms: libgazebo_ros_depth_camera.so/frameName
    tags = ("imageTopicName", "cameraInfoTopicName", "depthImageTopicName",
            "depthImageCameraInfoTopicName", "pointCloudTopicName")
    kinect(bench, "<frameName>optical</frameName>" + "".join(
        f"<{tag}>t{i}</{tag}>" for i, tag in enumerate(tags)), plugin)
    heard = [bench.listen(f"/eye/t{i}") for i in range(5)]
    bench.run(0.15)
    assert [type(messages[0]).__name__.replace("Array", "") for messages in heard] == [
        "Image", "CameraInfo", "Image", "CameraInfo", "PointCloud2"]
    assert {messages[0].header.frame_id for messages in heard} == {"optical"}
    assert {messages[0].header.stamp for messages in heard} == {rospy.Time.from_sec(0.1)}


def test_depth_is_along_the_axis_within_the_cutoffs(bench):
    # conforms: topics of cameras/depth/image_raw
    # conforms: libgazebo_ros_openni_kinect.so/pointCloudCutoff
    # conforms: libgazebo_ros_openni_kinect.so/pointCloudCutoffMax
    steps(bench)
    for tags, near, far in (("", 1.5, math.nan),
                            ("<pointCloudCutoffMax>8</pointCloudCutoffMax>", 1.5, 7.0),
                            ("<pointCloudCutoff>2</pointCloudCutoff>", math.nan, math.nan)):
        kinect(bench, tags)
        depth = depth_of(one(bench, "/eye/depth/image_raw"))
        bench.delete("eye")
        np.testing.assert_allclose(depth[[5, 12, 20], 2], [near] * 3, rtol=1e-3)
        np.testing.assert_allclose(depth[[5, 12, 20], 28], [far] * 3, rtol=1e-3)
        assert np.isnan(depth[0, 16])


def test_depth_camera_sees_to_the_far_clip(bench):
    # conforms: libgazebo_ros_depth_camera.so/pointCloudCutoff
    steps(bench)
    kinect(bench, "<pointCloudCutoff>2</pointCloudCutoff>"
                  "<pointCloudCutoffMax>3</pointCloudCutoffMax>", DEPTH)
    depth = depth_of(one(bench, "/eye/depth/image_raw"))
    assert np.isnan(depth[12, 2]) and depth[12, 28] == pytest.approx(7.0, rel=1e-3)
    assert np.isnan(depth[0, 16])


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_millimetres(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so/useDepth16UC1Format
    # conforms: libgazebo_ros_depth_camera.so/useDepth16UC1Format
    steps(bench)
    kinect(bench, "<useDepth16UC1Format>true</useDepth16UC1Format>", plugin)
    depth = depth_of(one(bench, "/eye/depth/image_raw"))
    assert depth.dtype == np.uint16 and abs(int(depth[12, 2]) - 1500) <= 2 and depth[0, 16] == 0


@pytest.mark.parametrize("format", ["R8G8B8", "B8G8R8"])
def test_points_are_in_optical_axes_with_the_colour_of_what_they_are_on(bench, format):
    # conforms: topics of cameras/points
    bench.spawn(WALL)
    camera = SMALL.replace("<height>", f"<format>{format}</format><height>") + CLIP
    for plugin in (KINECT, DEPTH):
        bench.spawn(eye(plugin, "<frameName>any</frameName>", camera, "depth"))
        msg = one(bench, "/eye/points")
        bench.delete("eye")
        assert [field.name for field in msg.fields] == ["x", "y", "z", "rgb"] and msg.is_dense
        points, focal = points_of(msg), 32 / (2 * math.tan(1.047 / 2))
        assert points.shape == (24, 32)
        np.testing.assert_allclose(points["z"], 2.0, rtol=1e-3)
        np.testing.assert_allclose(points["x"][3], (np.arange(32) - 15.5) / focal * 2, rtol=1e-3)
        np.testing.assert_allclose(points["y"][:, 3], (np.arange(24) - 11.5) / focal * 2, rtol=1e-3)
        assert points["rgb"][5, 5].tolist() == [0, 0, 255, 0]  # blue, green, red


def test_points_that_are_not_there_are_nan(bench):
    # conforms: topics of cameras/points
    steps(bench)
    kinect(bench)
    msg = one(bench, "/eye/points")
    points = points_of(msg)
    assert not msg.is_dense
    assert all(math.isnan(points[axis][0, 16]) for axis in "xyz")


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_who_wakes_the_sensor(bench, plugin):
    # conforms: topics of cameras/depth/camera_info
    # conforms: topics of cameras/depth/camera_info
    # conforms: topics of cameras/camera_info
    # conforms: topics of cameras/camera_info
    kinect(bench, plugin=plugin)
    assert one(bench, "/eye/depth/camera_info") is None
    both = [bench.listen(f"/eye/{name}") for name in ("camera_info", "depth/camera_info")]
    bench.run(0.2)
    assert both[0] == both[1] and both[0]
    images = bench.listen("/eye/image_raw", 0)
    bench.listen("/eye/points")
    bench.run(0.2)
    assert images  # for the colours of the points


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_the_plugins_rate_thins_only_the_infos(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so/updateRate
    # conforms: libgazebo_ros_depth_camera.so/updateRate
    kinect(bench, "<updateRate>5</updateRate>", plugin, rate=20)
    heard = [bench.listen(f"/eye/{name}") for name in ("image_raw", "depth/image_raw",
                                                       "camera_info", "depth/camera_info")]
    bench.run(1.0)
    assert [len(messages) for messages in heard] == [20, 20, 5, 5]


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_calibration_tags_are_those_of_cameras(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so/Cx, libgazebo_ros_openni_kinect.so/Cy
    # conforms: libgazebo_ros_openni_kinect.so/focalLength
    # conforms: libgazebo_ros_openni_kinect.so/hackBaseline
    # conforms: libgazebo_ros_openni_kinect.so/distortionK1
    # conforms: libgazebo_ros_openni_kinect.so/distortionK2
    # conforms: libgazebo_ros_openni_kinect.so/distortionK3
    # conforms: libgazebo_ros_openni_kinect.so/distortionT1
    # conforms: libgazebo_ros_openni_kinect.so/distortionT2
    # conforms: libgazebo_ros_depth_camera.so/Cx, libgazebo_ros_depth_camera.so/Cy
    # conforms: libgazebo_ros_depth_camera.so/focalLength
    # conforms: libgazebo_ros_depth_camera.so/hackBaseline
    # conforms: libgazebo_ros_depth_camera.so/distortionK1
    # conforms: libgazebo_ros_depth_camera.so/distortionK2
    # conforms: libgazebo_ros_depth_camera.so/distortionK3
    # conforms: libgazebo_ros_depth_camera.so/distortionT1
    # conforms: libgazebo_ros_depth_camera.so/distortionT2
    kinect(bench, "<Cx>1</Cx><Cy>2</Cy><focalLength>3</focalLength><hackBaseline>4</hackBaseline>"
           + "".join(f"<distortion{tag}>{i}</distortion{tag}>"
                     for i, tag in enumerate(("K1", "K2", "T1", "T2", "K3"), 5)), plugin)
    msg = one(bench, "/eye/camera_info")
    assert (msg.K[2], msg.K[5], msg.K[0], msg.P[3]) == (1, 2, 3, -12)
    assert list(msg.D) == [5, 6, 7, 8, 9]


@pytest.mark.parametrize("plugin", [KINECT, DEPTH])
def test_distortion_of_the_sensor(bench, plugin):
    # conforms: libgazebo_ros_openni_kinect.so/autoDistortion
    # conforms: libgazebo_ros_openni_kinect.so/borderCrop
    # conforms: libgazebo_ros_depth_camera.so/autoDistortion
    # conforms: libgazebo_ros_depth_camera.so/borderCrop
    bench.spawn(WALL)
    for crop, corner in (("true", [255, 0, 0]), ("false", [0, 0, 0])):
        bench.spawn(eye(plugin, f"<autoDistortion>true</autoDistortion>"
                        f"<borderCrop>{crop}</borderCrop>",
                        SMALL + "<distortion><k1>-.4</k1></distortion>", "depth"))
        info, image = bench.listen("/eye/camera_info"), bench.listen("/eye/image_raw")
        bench.run(0.15)
        bench.delete("eye")
        assert info[0].D[0] == -0.4
        assert list(image[0].data[:3]) == corner
