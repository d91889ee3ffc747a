"""Pictures of a world at rest: drawn and converted once, sent at their rate with new stamps."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from camera_models import SMALL, WALL, eye, pair

from bullet_sim.pose import Pose
from bullet_sim_ros import convert
from bullet_sim_ros.cameras import camera_topics

CAMERA, KINECT = "libgazebo_ros_camera.so", "libgazebo_ros_openni_kinect.so"
PAIR = "libgazebo_ros_multicamera.so"
COUNTED = ((convert, "image_to_msg"), (convert, "depth_to_msg"), (convert, "points_to_msg"),
           (convert, "remove_outside"), (camera_topics, "compressed_to_msg"))


@pytest.fixture
def made(monkeypatch):
    """How often each conversion was done, by name."""
    counts = {name: 0 for _, name in COUNTED}

    def counted(name, convert):
        def wrapper(*arguments, **options):
            counts[name] += 1
            return convert(*arguments, **options)
        return wrapper

    for module, name in COUNTED:
        monkeypatch.setattr(module, name, counted(name, getattr(module, name)))
    return counts


@pytest.fixture
def drawn(monkeypatch, bench):
    """Views that were drawn."""
    kind, views = type(bench.simulation._drawing.renderer()), []
    draw = kind.draw
    monkeypatch.setattr(kind, "draw", lambda self, scene, view, *rest: (
        views.append(view), draw(self, scene, view, *rest))[1])
    return views


def begin(bench, drawn, text, *topics):
    """The messages of all topics, from when the camera's frame time has been measured."""
    bench.spawn(text)
    bench.run(0.05)
    bench.spawn(WALL)
    drawn.clear()
    return [bench.listen(topic) for topic in topics]


def sent(message):
    """Its bytes after the header."""
    whole, header = BytesIO(), BytesIO()
    message.serialize(whole)
    message.header.serialize(header)
    return whole.getvalue()[len(header.getvalue()):]


def check(messages, count, contents):
    """So many, 0.1 s apart, with so many different contents."""
    stamps = [round(message.header.stamp.to_sec(), 3) for message in messages]
    assert len(stamps) == count and np.allclose(np.diff(stamps), 0.1)
    assert len({message.header.frame_id for message in messages}) == 1
    assert len({sent(message) for message in messages}) == contents


def move_wall(bench):
    """Its edge is ahead then."""
    bench.world.model("wall").set_pose(Pose((2.5, 4.5, 0.0)))


def test_a_colour_picture_and_its_compressed_twin(bench, drawn, made):
    # conforms: libgazebo_ros_camera.so
    colours = SMALL.replace("<height>", "<format>B8G8R8</format><height>")
    pictures = begin(bench, drawn, eye(CAMERA, camera=colours), "/eye/image_raw",
                     "/eye/image_raw/compressed", "/eye/camera_info")
    bench.run(1.0)
    for messages in pictures:
        check(messages, 10, 1)
    assert len(drawn) == made["image_to_msg"] == made["compressed_to_msg"] == 1
    move_wall(bench)
    bench.run(1.0)
    for messages in pictures[:2]:
        check(messages, 20, 2)
    assert len(drawn) == made["image_to_msg"] == made["compressed_to_msg"] == 2


@pytest.mark.parametrize("millimetres", [False, True])
def test_depth_and_points(bench, drawn, made, millimetres):
    # conforms: libgazebo_ros_openni_kinect.so
    tags = f"<useDepth16UC1Format>{str(millimetres).lower()}</useDepth16UC1Format>"
    pictures = begin(bench, drawn, eye(KINECT, tags, kind="depth"), "/eye/image_raw",
                     "/eye/depth/image_raw", "/eye/points")
    bench.run(1.0)
    for messages in pictures:
        check(messages, 10, 1)
    assert len(drawn) == 1 and set(made.values()) == {0, 1}
    move_wall(bench)
    bench.run(1.0)
    for messages in pictures:
        check(messages, 20, 2)
    assert len(drawn) == made["remove_outside"] == made["points_to_msg"] == 2


def test_points_that_nobody_wants_are_forgotten(bench, drawn, made):
    # conforms: libgazebo_ros_openni_kinect.so
    begin(bench, drawn, eye(KINECT, kind="depth"), "/eye/depth/image_raw", "/eye/points")
    for listeners in (1, 0, 1):
        bench.listen("/eye/points", listeners)
        bench.run(0.3)
    assert made["points_to_msg"] == 2 and made["depth_to_msg"] == 1 and len(drawn) == 1


def test_noise_is_added_to_each(bench, drawn, made):
    # conforms: sdf sensor/camera/noise/stddev
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>0.05</stddev></noise>"
    (messages,) = begin(bench, drawn, eye(CAMERA, camera=SMALL + noise), "/eye/image_raw")
    bench.run(1.0)
    check(messages, 10, 10)
    assert len(drawn) == 1


def test_noise_is_in_the_colours_of_points_too(bench, drawn, made):
    # conforms: libgazebo_ros_openni_kinect.so
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>0.05</stddev></noise>"
    depths, points = begin(bench, drawn, eye(KINECT, camera=SMALL + noise, kind="depth"),
                           "/eye/depth/image_raw", "/eye/points")
    bench.run(1.0)
    check(depths, 10, 1)
    check(points, 10, 10)
    assert len(drawn) == 1


def test_both_of_a_pair(bench, drawn):
    # conforms: libgazebo_ros_multicamera.so
    pictures = begin(bench, drawn, pair(PAIR), "/eye/left/image_raw", "/eye/right/image_raw")
    bench.run(1.0)
    for messages in pictures:
        check(messages, 10, 1)
    assert len(drawn) == 2
    move_wall(bench)
    bench.run(1.0)
    for messages in pictures:
        check(messages, 20, 2)
    assert len(drawn) == 4 and sent(pictures[0][-1]) != sent(pictures[1][-1])


def test_a_message_that_was_sent_is_not_changed(bench, drawn):
    """A latched one may still be serialized for a new subscriber."""
    # conforms: topics of cameras/image_raw
    (messages,) = begin(bench, drawn, eye(CAMERA), "/eye/image_raw")
    bench.run(0.15)
    before = messages[0].header.stamp
    bench.run(0.3)
    assert messages[0].header.stamp == before and len(messages) == 5


def test_the_time_of_a_frame_is_that_of_drawing(bench, drawn):
    """It is measured before the first picture, and not of pictures that are sent again."""
    # conforms: libgazebo_ros_camera.so
    bench.spawn(eye(CAMERA))
    bench.run(0.05)
    assert len(drawn) == camera_topics.TRIALS + 1
