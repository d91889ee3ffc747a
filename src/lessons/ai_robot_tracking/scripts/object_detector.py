#!/usr/bin/env python3
"""Detects objects in a topic's images with a YOLO network.  用 YOLO 网络检测图像里的物体。

rosrun ai_robot_tracking object_detector.py image:=/camera/rgb/image_raw [_model:=FILE.onnx]
"""

import os
import sys
import time

import cv2
import rosgraph
import rospy
from ai_robot_tracking.detection.decoding import nothing
from ai_robot_tracking.detection.messages import (
    PictureError,
    annotated,
    detections_of,
    image_of,
    rgb_of,
)
from ai_robot_tracking.detection.model import Model, ModelError
from ai_robot_tracking.detection.newest import Newest
from ai_robot_tracking.detection.settings import Settings
from ai_robot_tracking.detection.silence import why_silent
from ai_robot_tracking.parameters import own_parameters
from node_basics.settings import SettingsError, load_settings
from sensor_msgs.msg import Image
from vision_msgs.msg import Detection2DArray, VisionInfo

PACKAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..")
TEXTS = ("model", "image", "config")
NUMBERS = Settings.__dataclass_fields__.keys()
KEYS = {*NUMBERS, *TEXTS, "class_names", "window"}
WINDOW = "YOLO Detection"
COMPLAINT_TIME, SKIP_TIME, QUIET_TIME = 5.0, 5.0, 5.0  # s, wall
TICK = 0.2  # s, wall: longest wait, so that Ctrl-C works promptly
BUFFER = 2**24  # bytes: with rospy's default, images queue up and become old


class ObjectDetector:
    """Takes the newest image, runs the network, publishes the detections."""

    def __init__(self, model, settings, topic, window):
        self.model, self.settings, self.window = model, settings, window
        self.pictures = Newest()
        self.topic, self.reason = topic, ""
        self.detections = rospy.Publisher("~detections", Detection2DArray, queue_size=1)
        self.annotated = rospy.Publisher("~annotated", Image, queue_size=1)
        self.info = rospy.Publisher("~vision_info", VisionInfo, queue_size=1, latch=True)
        self.publish_names()
        rospy.Subscriber(self.topic, Image, self.pictures.put, queue_size=1, buff_size=BUFFER)

    def publish_names(self):
        """Class n is entry n of the list in the parameter that VisionInfo names."""
        parameter = rospy.resolve_name("~class_names")
        rospy.set_param(parameter, self.model.names)
        info = VisionInfo(method=f"YOLO {self.model.layout}, {self.model.path.name}",
                          database_location=parameter, database_version=1)
        info.header.stamp = rospy.Time.now()
        self.info.publish(info)

    def run(self):
        """Runs until shutdown; only the newest image counts."""
        heard = told = due = time.monotonic()
        while not rospy.is_shutdown():
            message = self.next_picture(due)
            now = time.monotonic()
            if message is not None:
                heard = now
                try:
                    self.work(message)
                except rospy.ROSException:
                    if not rospy.is_shutdown():  # else its topics were closed meanwhile
                        raise
                if self.settings.max_rate > 0:  # in wall time, to limit the machine's load
                    due = now + 1 / self.settings.max_rate
            elif now - max(heard, due) > QUIET_TIME:
                self.tell_silence(now - heard)
            if now - told > SKIP_TIME:
                self.tell_skipped(now - told)
                told = now

    def next_picture(self, due):
        """The newest image, not before `due` (wall s), or None after a TICK or two."""
        rest = due - time.monotonic()
        time.sleep(min(max(rest, 0.0), TICK))
        return self.pictures.take(TICK) if rest <= TICK else None

    def work(self, message):
        """Process one image; log and skip one that cannot be read."""
        try:
            rgb = rgb_of(message)
        except PictureError as error:
            rospy.logwarn_throttle(COMPLAINT_TIME, f"{self.topic}: {error}; skipped")
            return
        if (rgb == rgb[0, 0]).all():
            rospy.logwarn_throttle(COMPLAINT_TIME, f"{self.topic}: the image is one colour all "
                                   "over; is something in front of the camera?")
            found = nothing()
        else:
            found = self.model.detect(rgb, self.settings.confidence, self.settings.iou)
        self.detections.publish(detections_of(found, message.header))
        if self.window or self.annotated.get_num_connections():
            picture = annotated(rgb, found, self.model.names)
            self.annotated.publish(image_of(picture, message.header))
            if self.window:
                cv2.imshow(WINDOW, cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
                cv2.waitKey(1)  # ms

    def tell_silence(self, span):
        """Warn that no image has come for `span` s, and why; the same reason only once."""
        try:
            reason = why_silent(self.topic, rospy.get_published_topics(), rospy.get_name())
        except OSError:  # the master has ended
            reason = ""
        if not reason:
            rospy.logwarn_throttle(COMPLAINT_TIME, f"no image on {self.topic} for {span:.0f} s")
        elif reason != self.reason:
            rospy.logwarn(reason)
        self.reason = reason

    def tell_skipped(self, span):
        """Log one line if images came faster than they were processed; `span` is in s."""
        taken, skipped = self.pictures.counts()
        if skipped:
            rospy.loginfo(f"{skipped} of {taken + skipped} images skipped in {span:.0f} s: "
                          f"processed {taken / span:.1f} a second, always the newest")


def main():
    """Exit code 1, with one line, if the model or a parameter is invalid."""
    rospy.init_node("object_detector")
    try:
        given = own_parameters()
        for key in sorted(set(given) - KEYS):
            raise SettingsError(f"unknown parameter ~{key}; known: {', '.join(sorted(KEYS))}")
        for key in TEXTS:
            if not isinstance(given.get(key, ""), str):
                raise SettingsError(f"~{key} must be a name, not {given[key]!r}")
        if given.get("window", True) not in (True, False):
            raise SettingsError(f"~window must be true or false, not {given['window']!r}")
        topic = rospy.resolve_name(given.get("image") or "image")
        if not rosgraph.names.is_legal_name(topic):
            raise SettingsError(f"'{topic}' cannot be a topic; see: rostopic list")
        config = given.get("config") or os.path.join(PACKAGE, "config/detector_params.yaml")
        path = given.get("model") or os.path.join(PACKAGE, "models/objects.onnx")
        numbers = {key: given[key] for key in NUMBERS if key in given}
        settings = load_settings(Settings, os.path.expanduser(config), given=numbers)
        model = Model(os.path.expanduser(path), settings.threads)
    except (ModelError, SettingsError) as error:
        rospy.logfatal(str(error))
        return 1
    detector = ObjectDetector(model, settings, topic, given.get("window", True))
    rospy.loginfo(f"looking for {', '.join(model.names)} on {detector.topic}"[:200])
    detector.run()
    return 0


if __name__ == "__main__":
    sys.exit(main())
