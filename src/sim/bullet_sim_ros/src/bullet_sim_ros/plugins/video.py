"""libgazebo_ros_video.so: shows the images of a topic on a visual."""

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import Image

from bullet_sim.description import Box, Cylinder, Geometry, Material, Mesh, Plane, Sphere, Visual
from bullet_sim.errors import PluginError
from bullet_sim.pose import Pose
from bullet_sim.rendering.frame import LARGEST_PX
from bullet_sim_ros import names
from bullet_sim_ros.cameras.encodings import decode
from bullet_sim_ros.plugin_host import PluginContext, plugin

_ABOVE = 0.51  # of the visual's height, from its middle: 1 % above its upper side
_ABOVE_PLANE = 0.001  # m
_COMPLAIN = 10.0  # s between warnings


@plugin("libgazebo_ros_video.so")
class VideoPlugin:
    """A screen over the visual's +z side, black until an image comes; light does not change it."""

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._size_px = (_pixels(context, "width", 320), _pixels(context, "height", 240))
        self._scene = context.world.scene
        link, visual = context.link, context.visual
        self._name = f"video {link.scoped_name}::{visual.name}::{context.description.name}"
        self._show(np.zeros((*self._size_px[::-1], 3), np.uint8))
        width, height, above = _side(visual.geometry)
        self._scene.add_visual((context.model.name, link.name), Visual(
            self._name, Plane((0.0, 0.0, 1.0), (width, height)),
            visual.pose * Pose((0.0, 0.0, above)),
            Material(texture=self._name, lighting=False), cast_shadows=False))
        topic = names.join(p.namespace(missing="/", empty="/"), p.text("topicName", "image_raw"))
        self._topic = topic
        context.subscribe(topic, Image, self._take, queue_size=1)
        context.on_close(lambda: self._scene.images.pop(self._name, None))

    def _take(self, msg: Image):
        """In a ROS thread."""
        try:
            rgb = decode(msg)
        except ValueError as error:
            rospy.logwarn_throttle(_COMPLAIN, f"{self._topic}: {error}")
            return None
        if rgb.shape[1::-1] != self._size_px:
            rgb = cv2.resize(rgb, self._size_px)
        return lambda: self._show(rgb)

    def _show(self, rgb: np.ndarray) -> None:
        self._scene.images[self._name] = rgb


def _pixels(context: PluginContext, tag: str, default: int) -> int:
    value = context.parameters.number(tag, default)
    if not 1 <= value <= LARGEST_PX:
        raise PluginError(f"<{tag}> is {value:g}, which is not between 1 and {LARGEST_PX} px")
    return int(value)


def _side(shape: Geometry) -> tuple[float, float, float]:
    """Width and height of the screen, and how far it is above the middle, m."""
    match shape:
        case Box((x, y, z)) | Mesh(scale=(x, y, z)):
            return x, y, z * _ABOVE
        case Cylinder(radius, length):
            return 2 * radius, 2 * radius, length * _ABOVE
        case Sphere(radius):
            return 2 * radius, 2 * radius, 2 * radius * _ABOVE
        case Plane(size=(x, y)):
            return x, y, _ABOVE_PLANE
    raise PluginError(f"a {type(shape).__name__.lower()} has no side to show a video on")
