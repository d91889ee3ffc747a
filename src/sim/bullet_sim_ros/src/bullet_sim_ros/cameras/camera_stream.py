"""The images of a sensor: captured in the loop, rendered and published in the drawing thread."""

import logging
from collections.abc import Callable, Sequence
from concurrent.futures import Future

from std_msgs.msg import Empty

from bullet_sim.sensors.camera import pictures_rate
from bullet_sim_ros.cameras.camera_topics import CameraSettings, CameraTopics, Wanted
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.reconfigure_server import Value, offer_changes

log = logging.getLogger("bullet_sim.plugins")

SLOWEST, FASTEST, FIRST_RATE = 1.0, 50.0, 2.0  # Hz; imager_rate of cfg/GazeboRosCamera.cfg


class CameraStream:
    """The cameras of a sensor, which capture together, at a rate or on a trigger.

    A subscriber to the images of one has all of them rendered. So does gazebo_ros_camera_utils.cpp,
    ImageConnect, but it also renders for camera_info alone.
    """

    def __init__(self, context: PluginContext, cameras: Sequence[CameraTopics]):
        self._context = context
        self._cameras = cameras
        self._subscribed: list[Wanted] = []  # of each camera, when this was last looked up
        self._triggered = False
        self._drawn: Future | None = None  # the last capture's job
        context.on_close(self._close)

    def capture_at_rate(self, sensor_hz: float, thinned_hz: float = 0.0) -> None:
        """Capture at the sensor's rate, thinned to another (0: not), while anybody subscribes."""
        context = self._context
        context.every(pictures_rate(sensor_hz, thinned_hz), self._capture, self._wanted)
        for camera in self._cameras:
            _offer_rate(context, camera.settings, lambda rate_hz: context.change_rate(
                pictures_rate(rate_hz, thinned_hz)))

    def capture_on_trigger(self) -> None:
        """Capture at the step after a message on a trigger topic, if there are subscribers then.

        Several messages before the capture count as one. Rates have no effect.
        """
        for camera in self._cameras:
            topic = camera.settings.topic("triggerTopicName", "image_trigger")
            self._context.subscribe(topic, Empty, lambda _message: self._trigger, queue_size=1)
            _offer_rate(self._context, camera.settings, lambda _rate_hz: None)
        self._context.every(0.0, self._capture_once, lambda: self._triggered)

    def _trigger(self) -> None:
        self._triggered = True

    def _capture_once(self) -> None:
        self._triggered = False
        if self._wanted():
            self._capture()

    def _wanted(self) -> bool:
        self._subscribed = [camera.subscribed() for camera in self._cameras]
        return any(each.captures for each in self._subscribed)

    def _capture(self) -> None:
        """Runs in the loop, after `_wanted`; the rest is done in the drawing thread."""
        wanted = self._subscribed
        if any(each.pictures for each in wanted):
            self._context.host.lockstep.expect(self._context)
            wanted = [each._replace(image=True) for each in wanted]
        states = [camera.camera.capture() for camera in self._cameras]

        def publish() -> None:
            for camera, state, messages in zip(self._cameras, states, wanted, strict=True):
                camera.publish(state, messages)

        self._draw(publish)

    def _draw(self, job: Callable[[], None]) -> None:
        """Run `job` in the drawing thread; first waits for this group's previous job.

        An exception of the previous job is raised here. In lockstep the world waits for the image
        anyway, so the job runs at once in the loop.
        """
        host = self._context.host
        if host.lockstep.topics:
            host.drawing.settle()  # the renderer does one thing at a time
            job()
            host.drawing.settle()
            return
        if self._drawn is not None and not self._drawn.done():
            with host.world.profiler.measure("wait"):
                self._drawn.exception()
        if self._drawn is not None:
            self._drawn.result()
        self._drawn = host.drawing.submit(job)

    def _close(self) -> None:
        """Wait for the last image, before the topics that publish it are closed."""
        if self._drawn is not None:
            self._drawn.exception()
        self._drawn = None
        self._context.host.drawing.settle_rest()


def _offer_rate(context: PluginContext, settings: CameraSettings,
                change: Callable[[float], None]) -> None:
    """dynamic_reconfigure's `imager_rate` (Hz); `change` is called in the loop's thread.

    It starts at 2 whatever the sensor's rate is, and takes effect from the first change on
    (gazebo_ros_camera_utils.cpp, configCallback).
    """
    if not settings.camera_name:
        log.warning("%s: without a <cameraName> there is no dynamic_reconfigure for %s",
                    context.describe(), settings.image_topic)
        return
    rate = Value(FIRST_RATE, SLOWEST, FASTEST, "Rate of the sensor, Hz")
    offer_changes(context, settings.namespace, {"imager_rate": rate},
                  lambda values: change(values["imager_rate"]))
