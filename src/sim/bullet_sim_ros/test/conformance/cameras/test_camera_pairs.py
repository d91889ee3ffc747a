"""Pairs of cameras, cameras that wait to be told, and Prosilica's."""

import pytest
import rospy
from camera_models import WALL, eye, pair
from dynamic_reconfigure.msg import Config, DoubleParameter
from std_msgs.msg import Empty

from bullet_sim_ros.cameras.encodings import decode

PAIR, TOLD_PAIR = "libgazebo_ros_multicamera.so", "libgazebo_ros_triggered_multicamera.so"
TOLD, PROSILICA = "libgazebo_ros_triggered_camera.so", "libgazebo_ros_prosilica.so"


def test_left_and_right_by_their_names(bench, caplog):
    # conforms: libgazebo_ros_multicamera.so, libgazebo_ros_multicamera.so/cameraName
    # conforms: sdf sensor/camera@name
    # conforms: libgazebo_ros_multicamera.so/robotNamespace
    # conforms: libgazebo_ros_multicamera.so/imageTopicName
    # conforms: libgazebo_ros_multicamera.so/cameraInfoTopicName
    bench.spawn(pair(PAIR, "<imageTopicName>pic</imageTopicName><cameraInfoTopicName>info"
                     "</cameraInfoTopicName>", ("my_left", "the_right_one", "third")),
                namespace="/r")
    made = {name for name in bench.advertised() if name.startswith("/r/eye")}
    assert {"/r/eye/left/pic", "/r/eye/left/info", "/r/eye/right/pic", "/r/eye/right/info"} <= made
    assert not [name for name in made if "third" in name]
    assert "camera 'third' is left out: its name has neither left nor right" in caplog.text
    assert {"/r/eye/left/set_camera_info", "/r/eye/right/set_camera_info"} <= \
        bench.graph.services.keys()


def test_both_are_drawn_for_who_listens_to_one_at_the_same_moment(bench):
    # conforms: libgazebo_ros_multicamera.so
    bench.spawn(pair(PAIR))
    left, right = bench.listen("/eye/left/image_raw"), bench.listen("/eye/right/image_raw", 0)
    bench.run(0.35)
    assert len(left) == 3
    assert [image.header.stamp for image in left] == [image.header.stamp for image in right]


def test_each_stands_where_its_camera_says(bench):
    # conforms: libgazebo_ros_multicamera.so, sdf sensor/camera/pose
    bench.spawn(WALL.replace("2.05 0 0", "2.05 2.6 0").replace("9 9", "5 9"))  # its edge at y = 0.1
    bench.spawn(pair(PAIR))
    images = [bench.listen(f"/eye/{side}/image_raw") for side in ("left", "right")]
    bench.run(0.15)
    red = [(decode(messages[0])[12, :, 1] == 0).sum() for messages in images]
    assert red == [16, 13]  # 0.2 m at 2 m are 2.8 px


def test_only_the_right_one_has_a_baseline(bench):
    # conforms: libgazebo_ros_multicamera.so/hackBaseline, libgazebo_ros_multicamera.so/frameName
    bench.spawn(pair(PAIR, "<hackBaseline>0.2</hackBaseline><frameName>f</frameName>"))
    left, right = [bench.listen(f"/eye/{side}/camera_info") for side in ("left", "right")]
    bench.run(0.15)
    assert left[0].P[3] == 0 and right[0].P[3] == pytest.approx(-0.2 * right[0].K[0])
    assert left[0].header == right[0].header and left[0].header.frame_id == "f"


def test_the_rate_of_a_pair(bench):
    # conforms: libgazebo_ros_multicamera.so/updateRate
    # conforms: topics of cameras/set_parameters imager_rate
    bench.spawn(pair(PAIR, "<updateRate>5</updateRate>"))
    right = bench.listen("/eye/right/camera_info")
    bench.run(1.0)
    assert len(right) == 5
    bench.call("/eye/left/set_parameters",
               config=Config(doubles=[DoubleParameter("imager_rate", 2.0)]))
    bench.run(0.001)
    right.clear()
    bench.run(1.0)
    assert len(right) == 2


def test_calibration_tags_of_a_pair(bench):
    # conforms: libgazebo_ros_multicamera.so/Cx, libgazebo_ros_multicamera.so/Cy
    # conforms: libgazebo_ros_multicamera.so/focalLength
    # conforms: libgazebo_ros_multicamera.so/distortionK1
    # conforms: libgazebo_ros_multicamera.so/autoDistortion
    tags = "<Cx>1</Cx><Cy>2</Cy><focalLength>3</focalLength><distortionK1>4</distortionK1>"
    for auto, k1 in (("false", 4), ("true", 0)):
        bench.spawn(pair(PAIR, f"{tags}<autoDistortion>{auto}</autoDistortion>"))
        heard = [bench.listen(f"/eye/{side}/camera_info") for side in ("left", "right")]
        bench.run(0.15)
        bench.delete("eye")
        for (msg, *_) in heard:
            assert (msg.K[2], msg.K[5], msg.K[0], msg.D[0]) == (1, 2, 3, k1)


def test_a_pair_without_sides_is_an_error(bench, caplog):
    # conforms: libgazebo_ros_multicamera.so
    bench.spawn(pair(PAIR, names=("a", "b")))
    assert "needs a <camera> with left or right in its name" in caplog.text


@pytest.mark.parametrize("model, trigger, images", [
    (eye(TOLD), "/eye/image_trigger", ["/eye/image_raw"]),
    (eye(TOLD, "<triggerTopicName>now</triggerTopicName>"), "/eye/now", ["/eye/image_raw"]),
    (pair(TOLD_PAIR), "/eye/left/image_trigger", ["/eye/left/image_raw", "/eye/right/image_raw"]),
    (pair(TOLD_PAIR, "<triggerTopicName>now</triggerTopicName>"), "/eye/right/now",
     ["/eye/left/image_raw", "/eye/right/image_raw"]),
])
def test_a_picture_for_each_message_and_none_without(bench, model, trigger, images):
    # conforms: libgazebo_ros_triggered_camera.so, libgazebo_ros_triggered_multicamera.so
    # conforms: libgazebo_ros_triggered_camera.so/triggerTopicName
    # conforms: libgazebo_ros_triggered_multicamera.so/triggerTopicName
    # conforms: libgazebo_ros_triggered_multicamera.so/cameraName
    bench.spawn(model)
    assert bench.subscribed()[trigger] is Empty
    heard = [bench.listen(topic) for topic in images]
    bench.run(0.3)
    assert not any(heard)
    for moment in (0.3, 0.35):
        bench.send(trigger, Empty())
        bench.send(trigger, Empty())
        bench.run(0.05)
        for messages in heard:
            assert [m.header.stamp for m in messages] == [rospy.Time.from_sec(moment + 0.001)]
            messages.clear()


def test_a_trigger_without_listeners_is_not_kept(bench):
    # conforms: libgazebo_ros_triggered_camera.so
    bench.spawn(eye(TOLD))
    bench.send("/eye/image_trigger", Empty())
    bench.run(0.05)
    images = bench.listen("/eye/image_raw")
    bench.run(0.3)
    assert not images


def test_triggered_cameras_have_the_tags_of_cameras(bench):
    # conforms: libgazebo_ros_triggered_camera.so/cameraName
    # conforms: libgazebo_ros_triggered_camera.so/frameName
    # conforms: libgazebo_ros_triggered_camera.so/imageTopicName
    # conforms: libgazebo_ros_triggered_camera.so/cameraInfoTopicName
    # conforms: libgazebo_ros_triggered_camera.so/hackBaseline
    bench.spawn(eye(TOLD, "<frameName>f</frameName><hackBaseline>1</hackBaseline>"
                          "<imageTopicName>a</imageTopicName>"
                          "<cameraInfoTopicName>b</cameraInfoTopicName>"))
    images, infos = bench.listen("/eye/a"), bench.listen("/eye/b")
    bench.send("/eye/image_trigger", Empty())
    bench.run(0.05)
    assert images[0].header == infos[0].header and infos[0].header.frame_id == "f"
    assert infos[0].P[3] == -infos[0].K[0]


def test_the_right_one_of_a_triggered_pair_has_the_baseline(bench):
    # conforms: libgazebo_ros_triggered_multicamera.so/hackBaseline
    # conforms: libgazebo_ros_triggered_multicamera.so/frameName
    bench.spawn(pair(TOLD_PAIR, "<hackBaseline>1</hackBaseline><frameName>f</frameName>"))
    left, right = [bench.listen(f"/eye/{side}/camera_info") for side in ("left", "right")]
    bench.send("/eye/left/image_trigger", Empty())
    bench.run(0.05)
    assert left[0].P[3] == 0 and right[0].P[3] == -right[0].K[0]
    assert right[0].header.frame_id == "f"


@pytest.mark.parametrize("mode, seen, said", [
    (None, 3, ""), ("streaming", 3, ""), ("polled", 0, "polled_camera/GetPolledImage is not off"),
    ("other", 3, "/trigger_mode is 'other'; there are streaming and polled")])
def test_prosilica_streams(bench, caplog, mode, seen, said):
    # conforms: libgazebo_ros_prosilica.so, topics of cameras/trigger_mode of prosilica
    # conforms: libgazebo_ros_prosilica.so/cameraName, libgazebo_ros_prosilica.so/frameName
    # conforms: libgazebo_ros_prosilica.so/imageTopicName
    # conforms: libgazebo_ros_prosilica.so/cameraInfoTopicName
    if mode:
        bench.graph.parameters["/trigger_mode"] = mode
    bench.spawn(eye(PROSILICA, "<frameName>f</frameName><imageTopicName>a</imageTopicName>"
                               "<cameraInfoTopicName>b</cameraInfoTopicName>"))
    images, infos = bench.listen("/eye/a"), bench.listen("/eye/b")
    bench.run(0.35)
    assert len(images) == len(infos) == seen
    assert all(image.header.frame_id == "f" for image in images)
    assert said in caplog.text
