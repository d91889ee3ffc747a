"""One camera of a sensor together with its topics."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import rospy

from bullet_sim.sensors.camera import Camera, CameraReading, Exposure
from bullet_sim_ros.cameras.settings import CameraSettings
from bullet_sim_ros.cameras.topics import CameraTopics

if TYPE_CHECKING:
    from bullet_sim_ros.plugin_host.context import Host

TRIALS = 3
LONGEST_TRIAL = 0.2  # s, wall: a slow renderer is tried once


class Eye:
    """Draws and sends only what somebody listens to."""

    def __init__(self, host: Host, number: int = 0, suffix: str = "",
                 baseline: float | None = None):
        drawing = host.shared.drawing
        self._camera = Camera(host.world, host.link, host.sensor, drawing.renderer(),
                              number, host.parameters.flag("borderCrop", True))
        host.on_close(drawing.trim)
        self.settings = CameraSettings(host, self._camera.description, suffix, baseline)
        self.topics = CameraTopics(host, self.settings)
        _tell_frame_time(host, self._camera, self.settings.image_topic)

    def expose(self) -> Exposure:
        """In the loop's thread."""
        return self._camera.expose()

    def develop(self, exposure: Exposure, depth: bool = False) -> CameraReading:
        """In the drawing thread."""
        return self._camera.develop(exposure, depth)

    def send(self, exposure: Exposure, picture: bool) -> None:
        """A picture if asked for, and CameraInfo to those who listen; in the drawing thread."""
        if picture:
            self.topics.publish(self.develop(exposure))
        self.topics.publish_info(exposure.time)


def _tell_frame_time(host: Host, camera: Camera, topic: str) -> None:
    """Log what a picture of this camera costs to draw; by the drawing thread, before the first.

    A camera that has gone meanwhile is not drawn.
    """
    exposure = camera.expose()

    def measure() -> None:
        took: list[float] = []
        while len(took) <= TRIALS and sum(took[1:]) < LONGEST_TRIAL:
            if host.closed:
                return
            start = time.perf_counter()
            camera.develop(exposure)
            took.append(time.perf_counter() - start)
        view = exposure.view
        frame_ms = min(took[1:]) * 1e3  # the first one also loads what there is to see
        line = f"camera {topic} ({view.width}x{view.height}): {frame_ms:.1f} ms a frame"
        host.shared.mailbox.leave(lambda: rospy.loginfo("%s", line))

    host.shared.drawing.submit(measure)
