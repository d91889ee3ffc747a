"""rviz/Image: an image beside the view, and rviz/Camera: with the scene as the camera sees it.

An image is the page's own image stream (images.py). As in rviz, the camera's view is given by the
pose of the image's frame at its stamp and by the projection matrix P of the CameraInfo beside its
topic.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bullet_sim.pose import Pose
from sim_viewer.rviz.display_type import ERROR, OK, WARNING, DisplayType, Drawer, View
from sim_viewer.rviz.drawing import Part
from sim_viewer.rviz.options import Option

COMPRESSED = "/compressed"
RENDERINGS = ("background and overlay", "background", "overlay")
WIDTH_PX = 640  # of the image that is sent, at most
LARGEST_PX, LEAST_PX = 1 << 14, 1e-6  # a side of an image, a focal length


class Picture(Drawer):
    """Draws nothing in the view."""

    def draw(self, view: View) -> list[Part]:
        return []


IMAGE = DisplayType(
    "rviz/Image", Picture, messages=("sensor_msgs/Image", "sensor_msgs/CompressedImage"),
    topic="/camera/rgb/image_raw", topic_key="Image Topic")


@dataclass(frozen=True)
class Intrinsics:
    """Of an image of `size` px: focal lengths and principal point in px; `shift` in m to the right
    and down, of a stereo pair's second camera."""

    size: tuple[int, int]
    focal_length: tuple[float, float]
    principal_point: tuple[float, float]
    shift: tuple[float, float]


class Camera(Drawer):
    """The newest image, once there is a CameraInfo."""

    def __init__(self, options: dict[str, Any]):
        super().__init__(options)
        self._picture: Any = None  # the message
        self._pose: Pose | None = None
        self._jpeg = np.zeros(0, np.uint8)
        self._intrinsics: Intrinsics | None = None
        self.statuses = {"Camera Info": (WARNING, "No CameraInfo received")}

    def take(self, message: Any, pose: Pose | None, now: float) -> None:
        """An image with its pose, or a CameraInfo."""
        if not hasattr(message, "P"):
            self._picture, self._pose, self.changed = message, pose, True
            return
        found, self.statuses["Camera Info"] = intrinsics_of(message)
        self.changed = self.changed or found != self._intrinsics
        self._intrinsics = found

    def draw(self, view: View) -> list[Part] | None:
        """One part; Problem if the image cannot be shown."""
        if not self.changed:
            return None
        self.changed = False
        if self._picture is not None:
            picture, self._picture = self._picture, None
            self._jpeg = np.frombuffer(view.jpeg(picture, WIDTH_PX), np.uint8)
        if self._intrinsics is None or not len(self._jpeg):
            return []
        return [Part("camera", {"jpeg": self._jpeg}, {
            **vars(self._intrinsics), "rendering": self.options["Image Rendering"],
            "alpha": self.options["Overlay Alpha"], "zoom": self.options["Zoom Factor"],
        }, self._pose)]


def intrinsics_of(info: Any) -> tuple[Intrinsics | None, tuple[str, str]]:
    """The intrinsics of a sensor_msgs/CameraInfo, None if it is unusable, and its status."""
    across, down = info.P[0], info.P[5]
    if not np.isfinite(info.P).all():
        return None, (ERROR, "Contains invalid floating point values (nans or infs)")
    if not (0 < info.width <= LARGEST_PX and 0 < info.height <= LARGEST_PX
            and abs(across) > LEAST_PX and abs(down) > LEAST_PX):
        return None, (ERROR, f"CameraInfo of {info.width} x {info.height} px with focal lengths of "
                             f"{across:g} and {down:g} px: the camera is not calibrated")
    return Intrinsics((info.width, info.height), (across, down), (info.P[2], info.P[6]),
                      (-info.P[3] / across, -info.P[7] / down)), (OK, "OK")


def info_topic(picture_topic: str) -> str:
    """`/camera/camera_info` of `/camera/image_raw` and of `/camera/image_raw/compressed`."""
    return picture_topic.removesuffix(COMPRESSED).rpartition("/")[0] + "/camera_info"


CAMERA = DisplayType(
    "rviz/Camera", Camera, messages=("sensor_msgs/Image", "sensor_msgs/CompressedImage"),
    topic="/camera/rgb/image_raw", topic_key="Image Topic", beside="sensor_msgs/CameraInfo",
    beside_topic=info_topic, most_bytes=64 << 20, options=(
        Option("Image Rendering", "choice", RENDERINGS[0], RENDERINGS),
        Option("Overlay Alpha", "number", 0.5, high=1),
        Option("Zoom Factor", "number", 1.0, low=0.1, high=100)))
