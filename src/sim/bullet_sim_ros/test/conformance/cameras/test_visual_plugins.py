"""Plugins of visuals: a screen that shows a topic; and the projector, which shows nothing."""

import numpy as np
import pytest
from camera_models import eye
from sensor_msgs.msg import Image
from std_msgs.msg import Int32, String

from bullet_sim_ros.cameras.encodings import decode

VIDEO = '<plugin name="v" filename="libgazebo_ros_video.so">{}</plugin>'
FACING = "{} 0 0 1.5707963 0 -1.5707963"  # m ahead; +z looks back, +y is up
BLUE, GREEN = (0, 0, 255), (0, 255, 0)


def screen(tags="", geometry="<box><size>1 1 0.1</size></box>", where=FACING.format(2)):
    """A box whose +z side looks at the camera at the origin."""
    return f"""<model name="screen"><static>true</static><pose>{where}</pose><link name="l">
      <visual name="v"><geometry>{geometry}</geometry>{VIDEO.format(tags)}</visual>
    </link></model>"""


def image(top, bottom, size=(8, 40), encoding="rgb8"):
    pixels = np.empty((size[1], size[0], 3), np.uint8)
    pixels[:size[1] // 2], pixels[size[1] // 2:] = top, bottom
    if encoding == "bgr8":
        pixels = pixels[..., ::-1]
    return Image(height=size[1], width=size[0], step=3 * size[0], encoding=encoding,
                 data=pixels.tobytes())


def middle_of(bench):
    """The pixels of the picture's middle column, from the top."""
    images = bench.listen("/eye/image_raw")
    bench.run(0.15)
    return [tuple(pixel) for pixel in decode(images[-1])[:, 16].tolist()]


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8"])
def test_images_of_the_topic_are_on_the_screen(bench, encoding):
    # conforms: libgazebo_ros_video.so, libgazebo_ros_video.so/topicName
    # conforms: libgazebo_ros_video.so/robotNamespace, sdf visual/plugin
    bench.spawn(screen("<topicName>film</topicName>"), namespace="/r")
    bench.spawn(eye("libgazebo_ros_camera.so"))
    column = middle_of(bench)
    assert column.count((0, 0, 0)) >= 10  # black until something comes
    assert bench.subscribed()["/r/film"] is Image
    for top, bottom in ((BLUE, GREEN), (GREEN, BLUE)):
        bench.send("/r/film", image(top, bottom, encoding=encoding))
        column = middle_of(bench)
        half = column.index(bottom)
        assert 4 <= column[:half].count(top) <= 8 and 4 <= column[half:].count(bottom) <= 8


def test_the_topic_is_image_raw_by_default_and_ends_with_the_model(bench):
    # conforms: libgazebo_ros_video.so/topicName
    bench.spawn(screen())
    assert bench.subscribed()["/image_raw"] is Image
    assert len(bench.world.scene.images) == 1
    bench.delete("screen")
    assert "/image_raw" not in bench.subscribed() and not bench.world.scene.images


def test_images_are_shown_with_so_many_pixels(bench):
    # conforms: libgazebo_ros_video.so/width, libgazebo_ros_video.so/height
    bench.spawn(screen())
    shapes = [picture.shape for picture in bench.world.scene.images.values()]
    bench.delete("screen")
    bench.spawn(screen("<width>6</width><height>2</height>"))
    bench.send("/image_raw", image(BLUE, GREEN))
    bench.run(0.01)
    shapes += [picture.shape for picture in bench.world.scene.images.values()]
    assert shapes == [(240, 320, 3), (2, 6, 3)]


@pytest.mark.parametrize("geometry, where", [
    ("<cylinder><radius>0.5</radius><length>0.1</length></cylinder>", FACING.format(2)),
    ("<sphere><radius>0.5</radius></sphere>", FACING.format(2.5)),
    ("<plane><normal>0 0 1</normal><size>1 1</size></plane>", FACING.format(2))])
def test_any_shape_has_a_screen(bench, geometry, where):
    # conforms: libgazebo_ros_video.so
    bench.spawn(screen(geometry=geometry, where=where))
    bench.spawn(eye("libgazebo_ros_camera.so"))
    bench.send("/image_raw", image(BLUE, BLUE))
    column = middle_of(bench)
    assert 10 <= column.count(BLUE) <= 16


def test_two_screens_on_one_link_show_their_own(bench):
    # conforms: libgazebo_ros_video.so
    visual = """<visual name="{0}"><pose>0 {1} 0 0 0 0</pose><geometry><box><size>1 0.4 0.1</size>
      </box></geometry><plugin name="v" filename="libgazebo_ros_video.so"><topicName>{0}</topicName>
      </plugin></visual>"""
    bench.spawn(f'<model name="screen"><static>true</static><pose>{FACING.format(2)}</pose>'
                f'<link name="l">{visual.format("a", 0.4)}{visual.format("b", -0.4)}'
                "</link></model>")
    bench.spawn(eye("libgazebo_ros_camera.so"))
    bench.send("/a", image(BLUE, BLUE))
    bench.send("/b", image(GREEN, GREEN))
    column = middle_of(bench)
    assert column.count(BLUE) >= 4 and column.count(GREEN) >= 4


def test_an_image_that_cannot_be_read_changes_nothing(bench):
    # conforms: libgazebo_ros_video.so
    bench.spawn(screen())
    before = dict(bench.world.scene.images)
    for broken in (Image(height=2, width=2, step=6, encoding="rgb8", data=b"12"),
                   Image(height=2, width=2, step=6, encoding="yuv422", data=b"1" * 12)):
        bench.send("/image_raw", broken)
    bench.run(0.01)
    assert bench.world.scene.images == before


def test_projector_topics_are_there_and_nothing_is_drawn(bench, caplog):
    # conforms: libgazebo_ros_projector.so
    bench.spawn("""<model name="m"><link name="l"/><plugin name="p"
      filename="libgazebo_ros_projector.so"><projector>l/p</projector><textureTopicName>image
      </textureTopicName><projectorTopicName>on</projectorTopicName></plugin></model>""")
    assert bench.subscribed()["/image"] is String and bench.subscribed()["/on"] is Int32
    bench.send("/on", Int32(1))
    bench.run(0.01)
    assert "light of projector l/p is not drawn" in caplog.text


def test_an_unknown_plugin_of_a_visual_is_one_warning(bench, caplog):
    # conforms: sdf visual/plugin
    bench.spawn(screen().replace("gazebo_ros_video", "my_lamp"))
    assert "model screen: visual v: plugin v (libmy_lamp.so) is not known" in caplog.text
    assert "what it shows will be missing" in caplog.text


def test_a_screen_of_a_lumped_urdf_link(bench):
    # conforms: libgazebo_ros_video.so, libgazebo_ros_video.so/robotNamespace
    bench.spawn("""<robot name="r"><link name="base"><inertial><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
      <link name="tv"><visual><geometry><box size="1 1 .1"/></geometry></visual></link>
      <joint name="j" type="fixed"><parent link="base"/><child link="tv"/></joint>
      <gazebo reference="tv"><visual><plugin name="v" filename="libgazebo_ros_video.so">
        <topicName>film</topicName></plugin></visual></gazebo></robot>""", namespace="/q")
    assert "/q/film" in bench.subscribed()
