"""One camera of a sensor together with its topics."""

from __future__ import annotations

import time

import rospy

from bullet_sim.sensors.camera import Camera, CameraReading, CaptureState
from bullet_sim_ros.cameras.settings import CameraSettings
from bullet_sim_ros.cameras.topics import CameraTopics
from bullet_sim_ros.plugin_host.context import PluginContext

TRIALS = 3
LONGEST_TRIAL = 0.2  # s, wall: a slow renderer is tried once


class CameraPublisher:
    """Draws and sends only what somebody listens to."""

    def __init__(self, context: PluginContext, number: int = 0, suffix: str = "",
                 baseline: float | None = None):
        drawing = context.services.drawing
        self._camera = Camera(context.world, context.link, context.sensor, drawing.renderer(),
                              number, context.parameters.flag("borderCrop", True))
        context.on_close(drawing.trim)
        self.settings = CameraSettings(context, self._camera.description, suffix, baseline)
        self.topics = CameraTopics(context, self.settings)
        _tell_frame_time(context, self._camera, self.settings.image_topic)

    def capture(self) -> CaptureState:
        """In the loop's thread."""
        return self._camera.capture()

    def render(self, state: CaptureState, depth: bool = False) -> CameraReading:
        """In the drawing thread."""
        return self._camera.render(state, depth)

    def send(self, state: CaptureState, picture: bool) -> None:
        """A picture if asked for, and CameraInfo to those who listen; in the drawing thread."""
        if picture:
            self.topics.publish(self.render(state))
        self.topics.publish_info(state.time)


def _tell_frame_time(context: PluginContext, camera: Camera, topic: str) -> None:
    """Log what a picture of this camera costs to draw; by the drawing thread, before the first.

    A camera that has gone meanwhile is not drawn.
    """
    state = camera.capture()

    def measure() -> None:
        took: list[float] = []
        while len(took) <= TRIALS and sum(took[1:]) < LONGEST_TRIAL:
            if context.closed:
                return
            start = time.perf_counter()
            camera.render(state)
            took.append(time.perf_counter() - start)
        view = state.view
        frame_ms = min(took[1:]) * 1e3  # the first one also loads what there is to see
        line = f"camera {topic} ({view.width}x{view.height}): {frame_ms:.1f} ms a frame"
        context.services.mailbox.post(lambda: rospy.loginfo("%s", line))

    context.services.drawing.submit(measure)
