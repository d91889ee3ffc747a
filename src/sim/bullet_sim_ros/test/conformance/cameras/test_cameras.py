"""libgazebo_ros_camera.so: tags, topics, services, and what a camera costs nobody."""

import logging
import math

import cv2
import numpy as np
import pytest
import rospy
from camera_models import SMALL, WALL, eye
from dynamic_reconfigure.msg import Config, DoubleParameter, IntParameter, StrParameter
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from bullet_sim.rendering.renderer import NoRenderer
from bullet_sim_ros.cameras.encodings import ENCODINGS, decode

CAMERA = "libgazebo_ros_camera.so"
FOCAL_PX = 32 / (2 * math.tan(1.047 / 2))


def one(bench, topic, seconds=0.15):
    """The first message on a topic from now on."""
    messages = bench.listen(topic)
    bench.run(seconds)
    return messages[0]


def info(bench, tags="", camera=SMALL):
    bench.spawn(eye(CAMERA, tags, camera))
    return one(bench, "/eye/camera_info")


def test_a_picture_that_is_too_large_is_smaller_in_all_that_tells_of_it(bench, caplog):
    # conforms: libgazebo_ros_camera.so
    told = info(bench, camera="<image><width>40000</width><height>400</height></image>")
    assert (told.width, told.height) == (8192, 81)
    assert "an image of 40000x400 px is not drawn" in caplog.text
    assert "8192x81 is used" in caplog.text


def test_topics_are_below_namespace_and_camera_name(bench):
    # conforms: libgazebo_ros_camera.so, libgazebo_ros_camera.so/cameraName
    # conforms: libgazebo_ros_camera.so/robotNamespace
    bench.spawn(eye(CAMERA), namespace="/r1")
    made = bench.advertised()
    assert made["/r1/eye/image_raw"] is Image and made["/r1/eye/camera_info"] is CameraInfo
    assert made["/r1/eye/image_raw/compressed"] is CompressedImage


def test_an_empty_namespace_is_the_model_name(bench):
    # conforms: libgazebo_ros_camera.so/robotNamespace
    bench.spawn(eye(CAMERA, "<robotNamespace/>"))
    assert "/eye/eye/image_raw" in bench.advertised()


def test_image_and_info_go_where_they_are_named(bench):
    # conforms: libgazebo_ros_camera.so/imageTopicName, libgazebo_ros_camera.so/cameraInfoTopicName
    bench.spawn(eye(CAMERA, "<imageTopicName>rgb/pic</imageTopicName>"
                            "<cameraInfoTopicName>/calibration</cameraInfoTopicName>"))
    made = bench.advertised()
    assert {"/eye/rgb/pic", "/eye/rgb/pic/compressed", "/calibration"} <= made.keys()
    assert "/eye/image_raw" not in made


def test_image_is_latched_and_info_is_not(bench):
    # conforms: topics of cameras, topics of cameras/image_raw
    bench.spawn(eye(CAMERA))
    options = {name: bench.graph.topics[name].publishers[0].options
               for name in ("/eye/image_raw", "/eye/camera_info")}
    assert options["/eye/image_raw"] == {"queue_size": 2, "latch": True}
    assert not options["/eye/camera_info"].get("latch")


def test_nothing_is_drawn_for_nobody_and_infos_come_with_images(bench, monkeypatch):
    # conforms: topics of cameras/camera_info, topics of cameras/image_raw
    bench.spawn(eye(CAMERA))
    bench.run(0.01)
    drawn = []
    renderer = bench.simulation._drawing.renderer()
    draw = type(renderer).draw
    monkeypatch.setattr(type(renderer), "draw",
                        lambda *args, **rest: drawn.append(args) or draw(*args, **rest))
    bench.run(0.4)
    assert not drawn
    infos = bench.listen("/eye/camera_info")
    bench.run(0.3)
    images = bench.listen("/eye/image_raw")
    infos.clear()
    bench.spawn(WALL)
    bench.run(0.3)
    assert len(drawn) == 1 and len(images) == len(infos) == 3
    assert [image.header for image in images] == [info.header for info in infos]


def test_frame_is_as_named_with_the_prefix_found_upwards(bench):
    # conforms: libgazebo_ros_camera.so/frameName
    bench.graph.parameters["/r1/tf_prefix"] = "r1"
    bench.spawn(eye(CAMERA, "<frameName>optical</frameName>"), namespace="/r1")
    assert one(bench, "/r1/eye/image_raw").header.frame_id == "r1/optical"
    assert one(bench, "/r1/eye/camera_info").header.frame_id == "r1/optical"


@pytest.mark.parametrize("sensor_hz, plugin_hz, seen", [(20, 0, 20), (20, 20, 20), (20, 15, 10),
                                                        (20, 50, 20), (0, 5, 5), (0, 0, 30)])
def test_plugin_only_thins_the_rate_of_the_sensor(bench, sensor_hz, plugin_hz, seen):
    # conforms: libgazebo_ros_camera.so/updateRate, sdf sensor/update_rate
    bench.spawn(eye(CAMERA, f"<updateRate>{plugin_hz}</updateRate>", rate=sensor_hz))
    images = bench.listen("/eye/image_raw")
    bench.run(1.0)
    assert len(images) == seen


def test_infos_default_to_the_picture_in_the_way_of_upstream(bench):
    # conforms: topics of cameras/camera_info
    msg = info(bench)
    assert (msg.width, msg.height, msg.distortion_model) == (32, 24, "plumb_bob")
    np.testing.assert_allclose(msg.K, [FOCAL_PX, 0, 16.5, 0, FOCAL_PX, 12.5, 0, 0, 1])
    np.testing.assert_allclose(msg.P, [FOCAL_PX, 0, 16.5, 0, 0, FOCAL_PX, 12.5, 0, 0, 0, 1, 0])
    assert list(msg.R) == [1, 0, 0, 0, 1, 0, 0, 0, 1] and list(msg.D) == [0] * 5


def test_intrinsics_as_written(bench, caplog):
    # conforms: libgazebo_ros_camera.so/Cx, libgazebo_ros_camera.so/Cy
    # conforms: libgazebo_ros_camera.so/focalLength, libgazebo_ros_camera.so/hackBaseline
    msg = info(bench, "<CxPrime>3</CxPrime><Cx>15</Cx><Cy>11</Cy><focalLength>40</focalLength>"
                      "<hackBaseline>0.07</hackBaseline>")
    assert (msg.K[0], msg.K[2], msg.K[5]) == (40, 15, 11)
    assert (msg.P[2], msg.P[3], msg.P[6]) == (15, pytest.approx(-2.8), 11)
    assert "<focalLength> is 40, but pictures of 32 px" in caplog.text


def test_a_focal_length_that_agrees_is_no_warning(bench, caplog):
    # conforms: libgazebo_ros_camera.so/focalLength
    with caplog.at_level(logging.WARNING):
        info(bench, f"<focalLength>{FOCAL_PX:.5f}</focalLength>")
    assert "focalLength" not in caplog.text


def test_distortion_as_written_is_told_in_the_order_of_opencv(bench, caplog):
    # conforms: libgazebo_ros_camera.so/distortionK1, libgazebo_ros_camera.so/distortionK2
    # conforms: libgazebo_ros_camera.so/distortionK3, libgazebo_ros_camera.so/distortionT1
    # conforms: libgazebo_ros_camera.so/distortionT2
    tags = "".join(f"<distortion{tag}>{value}</distortion{tag}>" for tag, value in (
        ("K1", 1), ("K2", 2), ("K3", 3), ("T1", 4), ("T2", 5)))
    assert list(info(bench, tags).D) == [1, 2, 4, 5, 3]
    assert "autoDistortion" in caplog.text


def test_distortion_of_the_sensor_is_told_if_asked_for(bench, caplog):
    # conforms: libgazebo_ros_camera.so/autoDistortion
    # conforms: sdf sensor/camera/distortion/k1, sdf sensor/camera/distortion/k2
    # conforms: sdf sensor/camera/distortion/k3, sdf sensor/camera/distortion/p1
    # conforms: sdf sensor/camera/distortion/p2
    camera = SMALL + "<distortion><k1>-.1</k1><k2>.2</k2><k3>.3</k3><p1>.4</p1><p2>.5</p2>" \
                     "</distortion>"
    assert list(info(bench, "<autoDistortion>true</autoDistortion>", camera).D) == [
        -0.1, 0.2, 0.4, 0.5, 0.3]
    assert "autoDistortion" not in caplog.text


def test_barrel_distortion_bends_the_picture_and_the_crop_can_be_left_out(bench):
    # conforms: libgazebo_ros_camera.so/borderCrop, sdf sensor/camera/distortion/k1
    barrel = SMALL + "<distortion><k1>-.4</k1></distortion>"
    bench.spawn(WALL)
    bench.spawn(eye(CAMERA, "<autoDistortion>1</autoDistortion>", barrel))
    bench.spawn(eye(CAMERA, "<autoDistortion>1</autoDistortion><borderCrop>false</borderCrop>",
                    barrel).replace("eye", "bare"))
    corners = [decode(one(bench, f"/{name}/image_raw"))[0, 0].tolist() for name in ("eye", "bare")]
    assert corners == [[255, 0, 0], [0, 0, 0]]


def test_formats_are_encoded(bench):
    # conforms: sdf sensor/camera/image/width, sdf sensor/camera/image/height
    # conforms: sdf sensor/camera/image/format
    bench.spawn(WALL)
    for format in ENCODINGS:
        bench.spawn(eye(CAMERA, camera=SMALL.replace(
            "<height>", f"<format>{format}</format><height>")))
        msg = one(bench, "/eye/image_raw")
        bench.delete("eye")
        assert (msg.encoding, msg.width, msg.height) == (ENCODINGS[format], 32, 24)
        assert msg.step * msg.height == len(msg.data)
        channels = {"rgb8": 3, "bgr8": 3, "rgb16": 6, "mono16": 2}.get(msg.encoding, 1)
        assert msg.step == 32 * channels
        shown = decode(msg)[10, 10].tolist()
        assert shown == ([76] * 3 if "mono" in msg.encoding else [255, 0, 0]), format


def test_an_unknown_format_is_an_error_and_bgr8(bench, caplog):
    # conforms: sdf sensor/camera/image/format
    bench.spawn(WALL)
    bench.spawn(eye(CAMERA, camera=SMALL.replace("<height>", "<format>YUV</format><height>")))
    msg = one(bench, "/eye/image_raw")
    assert (msg.encoding, list(msg.data[:3])) == ("bgr8", [0, 0, 255])
    assert "Unsupported Gazebo ImageFormat YUV; there are R8G8B8" in caplog.text


def test_compressed_is_drawn_for_who_listens_and_says_what_it_is(bench):
    # conforms: topics of cameras/image_raw/compressed
    bench.spawn(WALL)
    bench.spawn(eye(CAMERA, "<frameName>f</frameName>"))
    msg = one(bench, "/eye/image_raw/compressed")
    assert (msg.format, msg.header.frame_id) == ("rgb8; jpeg compressed bgr8", "f")
    assert msg.header.stamp == rospy.Time.from_sec(0.1)
    image = cv2.imdecode(np.frombuffer(msg.data, np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_allclose(image[10, 10], (0, 0, 255), atol=3)


@pytest.mark.parametrize("format, said", [("L8", "mono8; png compressed "),
                                          ("R16G16B16", "rgb16; png compressed bgr16"),
                                          ("BAYER_GBRG8", "bayer_gbrg8; png compressed ")])
def test_compression_is_chosen_by_parameter_and_while_it_runs(bench, format, said):
    # conforms: topics of cameras/image_raw/compressed
    # conforms: topics of cameras/set_parameters image_raw/compressed
    bench.graph.parameters["/eye/image_raw/compressed/format"] = "png"
    bench.spawn(eye(CAMERA, camera=SMALL.replace("<height>", f"<format>{format}</format><height>")))
    msg = one(bench, "/eye/image_raw/compressed")
    assert msg.format == said
    image = cv2.imdecode(np.frombuffer(msg.data, np.uint8), cv2.IMREAD_UNCHANGED)
    assert image.dtype == (np.uint16 if "16" in format else np.uint8)
    bench.call("/eye/image_raw/compressed/set_parameters", config=Config(
        strs=[StrParameter("format", "jpeg")], ints=[IntParameter("jpeg_quality", 5)]))
    assert "; jpeg compressed" in one(bench, "/eye/image_raw/compressed").format


def test_parameters_that_make_no_sense_are_left(bench):
    # conforms: topics of cameras/image_raw/compressed
    for name, value in (("format", "gif"), ("jpeg_quality", "high"), ("png_level", 77)):
        bench.graph.parameters[f"/eye/image_raw/compressed/{name}"] = value
    bench.spawn(eye(CAMERA))
    assert one(bench, "/eye/image_raw/compressed").format == "rgb8; jpeg compressed bgr8"


@pytest.mark.parametrize("camera, said", [
    (SMALL + "<horizontal_fov>0</horizontal_fov>", "<horizontal_fov> is 0.0, which is not between"),
    ("<image><width>0</width></image>", "an image of 0x240 px"),
])
def test_a_camera_that_cannot_be_is_one_error(bench, caplog, camera, said):
    # conforms: sdf sensor/camera/horizontal_fov, sdf sensor/camera/image/width
    before = bench.advertised()
    bench.spawn(eye(CAMERA, camera=camera))
    assert f"(libgazebo_ros_camera.so) is not loaded: sensor s of eye::l: {said}" in caplog.text
    assert bench.advertised() == before


def test_a_calibration_can_be_set(bench):
    # conforms: topics of cameras/set_camera_info
    bench.spawn(eye(CAMERA, "<frameName>f</frameName>"))
    given = CameraInfo(width=1, height=2, K=[1, 2, 3, 4, 5, 6, 7, 8, 9])
    assert bench.call("/eye/set_camera_info", camera_info=given).success
    msg = one(bench, "/eye/camera_info")
    assert (list(msg.K), msg.width, msg.header.frame_id) == (list(given.K), 1, "f")
    assert msg.header.stamp == rospy.Time.from_sec(0.1)


def test_the_rate_of_the_sensor_can_be_changed(bench):
    # conforms: topics of cameras/set_parameters imager_rate
    bench.spawn(eye(CAMERA, "<updateRate>25</updateRate>"))
    images = bench.listen("/eye/image_raw")
    bench.run(1.0)
    assert len(images) == 10  # not the 2 Hz that it says it begins with
    for rate, seen in ((5.0, 5), (50.0, 25)):
        bench.call("/eye/set_parameters",
                   config=Config(doubles=[DoubleParameter("imager_rate", rate)]))
        bench.run(0.001)
        images.clear()
        bench.run(1.0)
        assert len(images) == seen
    assert {"/eye/parameter_descriptions", "/eye/parameter_updates"} <= bench.advertised().keys()


def test_without_a_camera_name_nothing_can_be_reconfigured(bench, caplog):
    # conforms: libgazebo_ros_camera.so/cameraName
    bench.spawn(eye(CAMERA).replace("<cameraName>eye</cameraName>", ""))
    assert "/image_raw" in bench.advertised()
    assert "/set_parameters" not in bench.graph.services
    assert "without a <cameraName> there is no dynamic_reconfigure" in caplog.text


def test_two_cameras_of_one_name_both_publish(bench, caplog):
    # conforms: libgazebo_ros_camera.so, topics of cameras
    before = bench.advertised()
    bench.spawn(eye(CAMERA))
    one_alone = {name: len(bench.graph.topics[name].publishers) for name in bench.advertised()}
    caplog.clear()
    bench.spawn(eye(CAMERA), name="second")
    taken = [record.getMessage() for record in caplog.records]
    assert len(taken) == 3 and all("is not offered" in line for line in taken), taken
    images = bench.listen("/eye/image_raw")
    bench.run(0.2)
    assert len(images) == 4  # 10 Hz, twice
    assert {name for name, count in one_alone.items()
            if len(bench.graph.topics[name].publishers) > count} == {
                "/eye/image_raw", "/eye/image_raw/compressed", "/eye/camera_info"}
    bench.delete("eye")
    images.clear()
    bench.run(0.2)
    assert len(images) == 2
    bench.delete("second")
    assert bench.advertised() == before


def test_all_ends_with_the_model(bench):
    # conforms: libgazebo_ros_camera.so
    before = bench.advertised(), dict(bench.graph.services)
    bench.spawn(eye(CAMERA))
    bench.delete("eye")
    assert (bench.advertised(), dict(bench.graph.services)) == before


def test_a_camera_sees_what_is_in_front_of_it(bench):
    # conforms: sdf sensor/camera, sdf sensor/camera/horizontal_fov, sdf sensor/camera/pose
    # conforms: sdf sensor/camera/clip/near, sdf sensor/camera/clip/far
    # conforms: sdf sensor, sdf sensor/pose, sdf sensor/plugin
    bench.spawn(WALL.replace("9 9", "1 1"))  # a square of 1 m, 2 m away

    def red(camera, sensor=""):
        bench.spawn(eye(CAMERA, camera=SMALL + camera, sensor=sensor))
        shown = decode(one(bench, "/eye/image_raw"))
        bench.delete("eye")
        return np.count_nonzero((shown[..., 0] == 255) & (shown[..., 1] == 0))

    usual = red("")
    assert usual == pytest.approx((FOCAL_PX / 2) ** 2, rel=0.2)
    assert red("<horizontal_fov>0.5</horizontal_fov>") > 3 * usual
    assert red("<clip><near>0.1</near><far>1.5</far></clip>") == 0
    assert red("<clip><near>2.5</near><far>9</far></clip>") == 0
    assert red("<pose>0 0 0 0 0 3.14</pose>") == 0
    assert red("", "<pose>0 0 0 0 0 3.14</pose>") == 0
    assert red("<pose>0 0 0 0 0 3.14</pose>", "<pose>0 0 0 0 0 3.14</pose>") == usual


def test_noise_is_gaussian_in_parts_of_full_brightness(bench):
    # conforms: sdf sensor/camera/noise/type, sdf sensor/camera/noise/mean
    # conforms: sdf sensor/camera/noise/stddev
    for kind, mean, deviation in (("gaussian", 25.5, 5.1), ("none", 0, 0)):
        bench.spawn(eye(CAMERA, camera=f"""<image><width>80</width><height>60</height></image>
          <noise><type>{kind}</type><mean>0.1</mean><stddev>0.02</stddev></noise>
          <pose>0 0 0 0 -1.5 0</pose>"""))
        shown = decode(one(bench, "/eye/image_raw")).astype(float)
        bench.delete("eye")
        assert shown.mean() == pytest.approx(178.5 + mean, abs=0.6)
        assert shown.std() == pytest.approx(deviation, rel=0.05)


def test_a_wide_angle_camera_sees_beside_itself(bench):
    # conforms: sdf sensor/camera/lens/type, sdf sensor/camera/lens/cutoff_angle
    # conforms: libgazebo_ros_camera.so
    bench.spawn(WALL.replace("2.05 0 0 0 0 0", "0 2.05 0 0 0 1.5707963"))  # on the left
    fisheye = """<horizontal_fov>6.283</horizontal_fov><image><width>64</width><height>64</height>
      </image><lens><type>equidistant</type><cutoff_angle>3.1416</cutoff_angle>
      <env_texture_size>64</env_texture_size></lens>"""
    bench.spawn(eye(CAMERA, camera=fisheye, kind="wideanglecamera"))
    shown = decode(one(bench, "/eye/image_raw"))
    assert shown[32, 16].tolist() == [255, 0, 0]  # 90 degrees to the left: half the way out
    assert shown[32, 48, 1] > 100 and shown[32, 32, 1] > 100


def test_a_reset_of_time_does_not_end_the_pictures(bench):
    # conforms: libgazebo_ros_camera.so
    bench.spawn(eye(CAMERA))
    images = bench.listen("/eye/image_raw")
    bench.run(0.5)
    bench.call("/gazebo/reset_simulation")
    bench.run(0.35)
    assert len(images) == 8 and images[-1].header.stamp == rospy.Time.from_sec(0.3)


@pytest.mark.parametrize("kind, said", [
    ("logical_camera", "type logical_camera is not simulated; without a plugin"),
    ("camra", "there is no type 'camra'; there are camera, wideanglecamera"),
])
def test_sensors_that_nobody_reads_are_said_once(bench, caplog, kind, said):
    # conforms: sdf sensor@type
    bench.spawn(f'<model name="m"><link name="l"><sensor name="s" type="{kind}"/></link></model>')
    assert caplog.text.count("model m: sensor s: " + said) == 1


def test_a_robot_with_a_camera_is_refused_where_no_camera_can_be_drawn(
        make_bench, monkeypatch):
    # conforms: /gazebo/spawn_sdf_model, libgazebo_ros_camera.so
    def broken(profiler):
        raise NoRenderer("cameras cannot be drawn")

    monkeypatch.setattr("bullet_sim_ros.drawing.open_renderer", broken)
    bench = make_bench()
    before = bench.advertised()
    drive = '<plugin name="p" filename="libgazebo_ros_p3d.so"><bodyName>l</bodyName></plugin>'
    model = eye(CAMERA).replace("</model>", f"{drive}</model>")
    answer = bench.call("/gazebo/spawn_sdf_model", model_name="eye",
                        model_xml=f'<sdf version="1.6">{model}</sdf>')
    assert (answer.success, answer.status_message) == (False, "cameras cannot be drawn")
    assert "eye" not in bench.world.models and bench.advertised() == before
