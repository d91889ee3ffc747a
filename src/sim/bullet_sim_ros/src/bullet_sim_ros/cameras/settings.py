"""The tags that all camera plugins know."""

import logging
import math

from bullet_sim.description import CameraDescription
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.cameras.encodings import ENCODINGS, UNKNOWN_FORMAT
from bullet_sim_ros.plugin_host import PluginContext

log = logging.getLogger("bullet_sim.plugins")

_DISTORTION = ("K1", "K2", "T1", "T2", "K3")  # the order of CameraInfo's D
_SAME_FOCAL_PX = 1e-3
_SAME_DISTORTION = 1e-6  # many files write 1e-8 for none


class CameraSettings:
    """The tags of a `<plugin>` about one camera.

    `suffix` is added to the namespace of a camera that is one of a pair, `baseline` (m) is its
    distance from the other; without it `<hackBaseline>` counts. `<CxPrime>` has no effect, as in
    gazebo_ros_camera_utils.cpp, Init.
    """

    def __init__(self, context: PluginContext, description: CameraDescription, suffix: str = "",
                 baseline: float | None = None):
        p = context.parameters
        self._context = context
        self._description = description
        self.camera_name = p.text("cameraName") + suffix
        self.namespace = names.join(p.namespace(missing="/", empty=context.model.name),
                                    self.camera_name)
        self.frame = names.frame(params.tf_prefix(self.namespace), p.text("frameName"))
        self.image_topic = self.topic("imageTopicName", "image_raw")
        self.info_topic = self.topic("cameraInfoTopicName", "camera_info")
        self.rate_hz = p.number("updateRate", 0.0)
        self.encoding = self._encoding()
        self.info = convert.camera_info_to_msg(
            description, 0.0, self.frame, centre_x=p.number("Cx", 0.0),
            centre_y=p.number("Cy", 0.0), focal_length=self._focal_length_px(),
            baseline=p.number("hackBaseline", 0.0) if baseline is None else baseline,
            distortion=self._distortion())

    def topic(self, tag: str, default: str) -> str:
        """The topic that a tag names, in the camera's namespace."""
        return names.join(self.namespace, self._context.parameters.text(tag, default))

    def _encoding(self) -> str:
        format = self._description.format
        if format not in ENCODINGS:
            log.error("%s: Unsupported Gazebo ImageFormat %s; there are %s; %s is used",
                      self._context.describe(), format, ", ".join(ENCODINGS), UNKNOWN_FORMAT)
        return ENCODINGS.get(format, UNKNOWN_FORMAT)

    def _focal_length_px(self) -> float:
        """`<focalLength>` as written; 0 stands for that of the rendered image."""
        written = self._context.parameters.number("focalLength", 0.0)
        camera = self._description
        drawn = camera.width / (2 * math.tan(camera.horizontal_fov / 2))
        if written and abs(written - drawn) > _SAME_FOCAL_PX:
            log.warning(
                "%s: <focalLength> is %g, but pictures of %d px with a <horizontal_fov> of %g rad "
                "have %g; only camera_info has the former: leave the tag out", self._context.
                describe(), written, camera.width, camera.horizontal_fov, drawn)
        return written

    def _distortion(self) -> tuple[float, ...]:
        p, drawn = self._context.parameters, self._description.distortion
        if p.flag("autoDistortion", False):
            return drawn
        written = tuple(p.number(f"distortion{tag}", 0.0) for tag in _DISTORTION)
        if max(abs(a - b) for a, b in zip(written, drawn, strict=True)) > _SAME_DISTORTION:
            log.warning(
                "%s: camera_info says D = %s by <distortionK1> and the like, but the picture is "
                "drawn by the <distortion> of the sensor's <camera>, %s; "
                "<autoDistortion>true</autoDistortion> makes them agree", self._context.describe(),
                list(written), list(drawn))
        return written
