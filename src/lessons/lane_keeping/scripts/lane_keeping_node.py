#!/usr/bin/env python3
"""The tutorial's lane keeper, and also: a mask for shade, search, people at zebra crossings.

车道保持：每收到一帧图像发一次速度指令，斑马线前有人则停车。
"""

import os
import sys
import threading
import time

import cv2
import cv_bridge
import rospy
from geometry_msgs.msg import Twist
from lane_keeping import lane_keeper
from lane_keeping.annotate import annotate
from lane_keeping.image_watch import mistake_in, picture_of
from lane_keeping.settings import load_settings
from node_basics.settings import SettingsError
from rospy.client import load_command_line_node_params
from sensor_msgs.msg import Image
from std_msgs.msg import String

CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../config/lane_keeping.yaml")
WINDOW = "lane_keeping"
CHECK_PERIOD = 0.1  # s
REPEAT = 5  # s between two warnings of the same kind
WARNINGS = {
    lane_keeper.LOST: "lane lost, following the last one seen  车道线丢失，沿用上一帧",
    lane_keeper.SEARCHING: "lane lost, turning to where it was  车道线丢失，原地转向寻找",
    lane_keeper.STOPPED: "no lane in sight, standing still  看不到车道线，停车",
    lane_keeper.BLANK: "the image on {topic} is blank, standing still  图像是空白的，停车",
    lane_keeper.FROZEN: "the image on {topic} is frozen, standing still  图像不再变化，停车",
}


class LaneKeeping:
    """Passes images to the LaneKeeper; sends, logs and shows its decisions."""

    def __init__(self, settings, window):
        self.settings, self.bridge = settings, cv_bridge.CvBridge()
        self.keeper = lane_keeper.LaneKeeper(settings)
        self.lock = threading.Lock()  # images and the timer run in different threads
        self.arrival, self.state = rospy.get_time(), None
        self.window = window
        if window:
            cv2.namedWindow(WINDOW, cv2.WINDOW_NORMAL)
        self.commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        self.pictures = rospy.Publisher("/lane_keeping/annotated", Image, queue_size=1)
        self.states = rospy.Publisher("/lane_keeping/state", String, queue_size=10, latch=True)
        self.images = rospy.Subscriber(
            "/camera", Image, self.take_image, queue_size=1, buff_size=2**24
        )
        self.timer = rospy.Timer(rospy.Duration(CHECK_PERIOD), self.check_images, reset=True)

    def take_image(self, msg):
        with self.lock:
            if rospy.is_shutdown():
                return  # stop() held the lock meanwhile: no command after the final one
            self.arrival = rospy.get_time()
            mistake = mistake_in(msg.encoding, msg.width, msg.height, msg.step, len(msg.data))
            if mistake:
                self.distrust("bad image", f"{mistake}, standing still  图像格式不对，停车")
                return
            image = picture_of(msg.encoding, msg.width, msg.height, msg.step, msg.data)
            decision = self.keeper.step(image, msg.header.stamp.to_sec(), self.arrival)
            self.send(decision.speed, decision.turn)
        self.say(decision.state, WARNINGS.get(decision.state))
        self.show(image, decision, msg.header)

    def show(self, image, decision, header):
        watched = self.pictures.get_num_connections() > 0
        if not (watched or self.window):
            return
        picture = annotate(image.copy(), decision)  # the keeper still needs the original
        if watched:
            self.pictures.publish(self.bridge.cv2_to_imgmsg(picture, "bgr8", header))
        if self.window:
            cv2.imshow(WINDOW, picture)
            cv2.waitKey(1)  # ms

    def say(self, state, warning):
        """Publish the state when it changes; log the warning, at most every REPEAT s."""
        if state != self.state:
            self.state = state
            self.states.publish(state)
        if warning:
            warning = warning.format(topic=self.images.resolved_name)
            rospy.logwarn_throttle_identical(REPEAT, warning)

    def distrust(self, state, warning):
        """Stop: the image is unusable."""
        self.keeper.stand()
        self.send(0.0, 0.0)
        self.say(state, f"{{topic}}: {warning}")

    def check_images(self, _event):
        with self.lock:
            late = rospy.get_time() - self.arrival
            if late < 0:
                self.arrival = rospy.get_time()  # time was reset
            elif late > self.settings.image_timeout:
                self.distrust("no image", "no image, standing still  没有图像，停车")

    def send(self, speed, turn):
        command = Twist()
        command.linear.x, command.angular.z = speed, turn
        self.commands.publish(command)

    def stop(self):
        """Stop before exiting: the car keeps following the last command.  退出前停车。"""
        self.timer.shutdown()
        self.images.unregister()  # else the next image would start the car again
        with self.lock:
            for _ in range(3):  # sending takes time
                self.send(0.0, 0.0)
                time.sleep(0.1)  # s of wall time: simulated time may be paused


def read_parameters(given):
    """Settings, and whether to show a window, from the node's parameters; SettingsError."""
    numbers = dict(given)
    path, window = numbers.pop("config", "") or CONFIG, numbers.pop("window", True)
    if not isinstance(path, str):
        raise SettingsError(f"the node's parameters: 'config' must be a file, not {path!r}")
    if window not in (True, False):
        raise SettingsError(f"the node's parameters: 'window' must be true or "
                            f"false, not {window!r}")
    return load_settings(os.path.expanduser(path), numbers), bool(window)


def main():
    rospy.init_node("lane_keeping")
    given = rospy.get_param("~", {})
    for key in load_command_line_node_params(sys.argv):
        rospy.delete_param(f"~{key}")  # _key:=value must not affect the next run
    try:
        if not isinstance(given, dict):
            raise SettingsError(f"rosparam delete {rospy.get_name()}: it is {given!r}, no table")
        node = LaneKeeping(*read_parameters(given))
    except SettingsError as error:
        rospy.logfatal("%s", error)
        sys.exit(1)
    rospy.on_shutdown(node.stop)  # Ctrl-C
    rospy.spin()


if __name__ == "__main__":
    main()
