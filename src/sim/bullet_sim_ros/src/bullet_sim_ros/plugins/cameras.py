"""The camera plugins: single, triggered, in pairs, streaming prosilica, and depth cameras."""

import logging

from bullet_sim.errors import PluginError
from bullet_sim_ros import params
from bullet_sim_ros.cameras.camera_stream import CameraStream
from bullet_sim_ros.cameras.camera_topics import FARTHEST, CameraTopics, DepthCameraTopics
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.plugins")

KINECT_FAR = 5.0  # m, where <pointCloudCutoffMax> is absent
STREAMING, POLLED = "streaming", "polled"


@plugin("libgazebo_ros_camera.so")
class CameraPlugin:
    """Also for sensors of type wideanglecamera."""

    def __init__(self, context: PluginContext):
        _capture_at_rate(context, [CameraTopics(context)])


@plugin("libgazebo_ros_triggered_camera.so")
class TriggeredCameraPlugin:
    """One image for each message on `triggerTopicName`."""

    def __init__(self, context: PluginContext):
        CameraStream(context, [CameraTopics(context)]).capture_on_trigger()


@plugin("libgazebo_ros_multicamera.so")
class MulticameraPlugin:
    """Both cameras capture at the same time and share a frame."""

    def __init__(self, context: PluginContext):
        _capture_at_rate(context, _pair(context))


@plugin("libgazebo_ros_triggered_multicamera.so")
class TriggeredMulticameraPlugin:
    """Each camera has a trigger topic; a message on either triggers both cameras."""

    def __init__(self, context: PluginContext):
        CameraStream(context, _pair(context)).capture_on_trigger()


@plugin("libgazebo_ros_prosilica.so")
class ProsilicaPlugin:
    """A streaming camera; polling it for single images is not supported.

    `trigger_mode` is searched for upwards from the camera's namespace, once.
    """

    def __init__(self, context: PluginContext):
        camera = CameraTopics(context)
        name = params.find_upwards(camera.settings.namespace, "trigger_mode")
        mode = str(params.below(name)) if name else STREAMING
        if mode == POLLED:
            log.warning("%s: %s is %s, and polled_camera/GetPolledImage is not offered here: there "
                        "will be no pictures; set it to %s", context.describe(), name, POLLED,
                        STREAMING)
            return
        if mode != STREAMING:
            log.error("%s: %s is %r; there are %s and %s; %s is used", context.describe(), name,
                      mode, STREAMING, POLLED, STREAMING)
        _capture_at_rate(context, [camera])


@plugin("libgazebo_ros_openni_kinect.so")
class OpenniKinectPlugin:
    """Colour, depth and points of one depth sensor, up to `pointCloudCutoffMax`."""

    def __init__(self, context: PluginContext):
        _capture_depth(context, context.parameters.number("pointCloudCutoffMax", KINECT_FAR))


@plugin("libgazebo_ros_depth_camera.so")
class DepthCameraPlugin:
    """A Kinect without an upper limit for depth.

    Publishes both camera_info topics; gazebo_ros_depth_camera.cpp never calls PublishCameraInfo.
    """

    def __init__(self, context: PluginContext):
        _capture_depth(context, FARTHEST)


def _capture_at_rate(context: PluginContext, cameras: list[CameraTopics]) -> None:
    CameraStream(context, cameras).capture_at_rate(context.sensor.update_rate,
                                                   cameras[0].settings.rate_hz)


def _capture_depth(context: PluginContext, far: float) -> None:
    """The plugin's rate counts only where the sensor has none."""
    camera = DepthCameraTopics(context, far)
    CameraStream(context, [camera]).capture_at_rate(
        context.sensor.update_rate or camera.settings.rate_hz)


def _pair(context: PluginContext) -> list[CameraTopics]:
    """The cameras with `left` or `right` in their names; only the right one has a baseline."""
    cameras = []
    for number, camera in enumerate(context.sensor.cameras):
        if "left" in camera.name:
            cameras.append(CameraTopics(context, number, "/left", 0.0))
        elif "right" in camera.name:
            cameras.append(CameraTopics(context, number, "/right",
                                        context.parameters.number("hackBaseline", 0.0)))
        else:
            log.warning("%s: camera %r is left out: its name has neither left nor right in it",
                        context.describe(), camera.name)
    if not cameras:
        raise PluginError(
            f"sensor {context.sensor.name} needs a <camera> with left or right in its name")
    return cameras
