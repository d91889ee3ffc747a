"""Image messages as JPEG: every encoding that cameras and windows send, sizes, and bad ones."""

import io
from types import SimpleNamespace

import cv2
import numpy as np
import pytest
import rospy
from cv_bridge import CvBridge
from sensor_msgs.msg import CompressedImage, Image
from sim_viewer import images
from sim_viewer.images import Stream, to_jpeg
from sim_viewer.registry import Refused

ORANGE = (0, 128, 255)  # BGR
bridge = CvBridge()


def shown(msg, width=960):
    """What the browser draws, BGR."""
    return cv2.imdecode(np.frombuffer(to_jpeg(msg, width), np.uint8), cv2.IMREAD_COLOR)


def plain(width=64, height=48, colour=ORANGE):
    return np.full((height, width, 3), colour, np.uint8)


def compressed(picture, ending=".jpg"):
    return CompressedImage(format=ending[1:], data=cv2.imencode(ending, picture)[1].tobytes())


@pytest.mark.parametrize("encoding", ["bgr8", "rgb8", "bgra8", "rgba8", "8UC3", "8UC4"])
def test_colours_are_the_cameras(encoding):
    code = {"bgr8": None, "rgb8": cv2.COLOR_BGR2RGB, "bgra8": cv2.COLOR_BGR2BGRA,
            "rgba8": cv2.COLOR_BGR2RGBA, "8UC3": None, "8UC4": cv2.COLOR_BGR2BGRA}[encoding]
    picture = plain() if code is None else cv2.cvtColor(plain(), code)
    got = shown(bridge.cv2_to_imgmsg(picture, encoding))
    assert np.abs(got.astype(int) - ORANGE).max() < 8


@pytest.mark.parametrize("encoding", ["bgr16", "rgb16", "rgba16"])
def test_colours_of_16_bit_are_the_cameras(encoding):
    picture = np.zeros((64, 64, 3), np.uint16)
    picture[:32, :, 0] = picture[32:, :, 2] = 60_000  # blue above, red below
    if encoding != "bgr16":
        picture = cv2.cvtColor(
            picture, cv2.COLOR_BGR2RGB if encoding == "rgb16" else cv2.COLOR_BGR2RGBA)
    got = shown(bridge.cv2_to_imgmsg(picture, encoding)).astype(int)
    assert np.abs(got[8, 32] - (255, 0, 0)).max() < 8
    assert np.abs(got[56, 32] - (0, 0, 255)).max() < 8


def test_pictures_of_a_pattern_of_colours():
    pattern = np.zeros((64, 64), np.uint8)
    pattern[::2, ::2] = 200  # of RGGB: all red
    got = shown(bridge.cv2_to_imgmsg(pattern, "bayer_rggb8")).astype(int)
    assert np.abs(got[32, 32] - (0, 0, 200)).max() < 30


def test_infinite_and_huge_numbers_do_no_harm():
    depth = np.repeat(np.float32([[-3e38, 3e38, np.inf, -np.inf]]), 16, axis=1).repeat(64, axis=0)
    got = shown(bridge.cv2_to_imgmsg(depth, "32FC1"))[32, 8::16, 0].astype(int)
    assert np.abs(got - [0, 255, 0, 0]).max() < 6


def test_tall_pictures_shrink_too():
    got = shown(bridge.cv2_to_imgmsg(np.full((70_000, 100), 90, np.uint8), "mono8"), 640)
    assert got.shape == (2000, 3, 3)


def test_grey_stays_grey():
    got = shown(bridge.cv2_to_imgmsg(np.full((48, 64), 90, np.uint8), "mono8"))
    assert np.abs(got.astype(int) - 90).max() < 4


@pytest.mark.parametrize(("kind", "encoding"), [(np.float32, "32FC1"), (np.uint16, "16UC1")])
def test_depths_are_spread_from_black_to_white(kind, encoding):
    depth = np.repeat(np.array([[1, 2, 3, 5]]), 16, axis=1).repeat(64, axis=0).astype(kind)
    got = shown(bridge.cv2_to_imgmsg(depth, encoding))[32, 8::16, 0]
    assert np.abs(got.astype(int) - [0, 63, 127, 255]).max() < 6


def test_depths_that_are_no_numbers_are_black():
    depth = np.full((64, 64), 2.0, np.float32)
    depth[:32], depth[32:, 32:] = np.nan, 4.0
    got = shown(bridge.cv2_to_imgmsg(depth, "32FC1"))
    assert got[8, 8].max() < 6 and got[56, 56].min() > 249
    assert shown(bridge.cv2_to_imgmsg(np.full((9, 9), np.nan, np.float32), "32FC1")).max() < 6


def test_wide_pictures_shrink_and_keep_their_shape():
    assert shown(bridge.cv2_to_imgmsg(plain(1920, 1080), "bgr8"), 640).shape == (360, 640, 3)
    assert shown(compressed(plain(1920, 1080)), 640).shape == (360, 640, 3)
    assert shown(compressed(plain(1000, 500), ".png"), 640).shape == (320, 640, 3)
    assert shown(bridge.cv2_to_imgmsg(plain(320, 240), "bgr8"), 640).shape == (240, 320, 3)


def test_a_jpeg_that_is_small_enough_goes_as_it_is():
    msg = compressed(plain(640, 480))
    assert to_jpeg(msg, 640) == msg.data
    assert to_jpeg(msg, 639) != msg.data


@pytest.mark.parametrize("msg", [
    Image(width=9, height=9, encoding="bgr8", step=27, data=b"short"),
    Image(width=9, height=9, encoding="nonsense", step=27, data=bytes(243)),
    Image(width=9, height=9, encoding="32FC2", step=72, data=bytes(648)),
    Image(width=9, height=9, encoding="8UC2", step=18, data=bytes(162)),
    Image(width=2**32 - 1, height=2**32 - 1, encoding="bgr8", step=27, data=bytes(243)),
    Image(encoding="bgr8"), CompressedImage(format="jpeg", data=b"no picture"),
    CompressedImage(format="jpeg", data=b"\xff\xd8\xff"), CompressedImage(),
], ids=["short", "encoding", "two numbers", "two bytes", "vast", "empty",
        "letters", "head", "nothing"])
def test_what_cannot_be_shown_is_refused_in_words(msg):
    with pytest.raises(Refused) as refused:
        to_jpeg(msg, 640)
    assert "OpenCV" not in str(refused.value)


def as_sent(msg, number):
    """A message as rospy hands it on unread, number and stamp filled in."""
    msg.header.seq, msg.header.stamp = number, rospy.Time(number)
    buffer = io.BytesIO()
    msg.serialize(buffer)
    return SimpleNamespace(_buff=buffer.getvalue())


def test_an_image_that_differs_in_its_header_alone_is_encoded_once(monkeypatch):
    monkeypatch.setattr(images.rospy, "Subscriber", lambda *_, **__: SimpleNamespace(
        resolved_name="/camera"))
    now = [0.0]
    monkeypatch.setattr(images.time, "monotonic", lambda: now[0])
    encoded = []
    monkeypatch.setattr(images, "to_jpeg", lambda *given: encoded.append(given) or to_jpeg(*given))
    stream, sent = Stream("/camera", Image, 640), []
    stream.add(sent.append)
    first, second = (bridge.cv2_to_imgmsg(plain(colour=colour), "bgr8")
                     for colour in (ORANGE, (0, 0, 0)))
    broken = Image(width=2, height=2, encoding="bgr8")
    for number, msg in enumerate((first, first, first, second, second, broken, broken, second)):
        now[0] += 1.0
        stream._take(as_sent(msg, number))
    expected = [to_jpeg(first, 640)] * 3 + [to_jpeg(second, 640)] * 2
    assert sent[:5] == expected and sent[7] == expected[4]
    assert all("error" in message for message in sent[5:7])
    assert len(encoded) == 5
