#!/usr/bin/env python3
"""Follows the yellow line by camera: finds it, steers with PID, slows down before bends.

One command on motor_output for each image; ~picture shows the image with what was found.
"""

import threading
import time

import cv2
import cv_bridge
import rospy
from car_control.images import picture_of
from car_control.lane.lane_driver import FOLLOWING, SEARCHING, STOPPED, LaneDriver
from car_control.lane.line_finding import LaneSettings, find_line
from car_control.node import Ending, StopNotice, read_settings, start_node
from geometry_msgs.msg import Twist
from node_basics.reconfigure import serve_settings
from node_basics.settings import checked
from sensor_msgs.msg import Image

CHECK_PERIOD = 0.1  # s
FLUSH_TIME = 0.2  # s, wall: rospy's threads need this to send before the process ends


class LaneFollow:
    """The node: passes images to LaneDriver, which does all the driving, and logs its state."""

    def __init__(self, settings):
        self.driver, self.bridge = LaneDriver(settings), cv_bridge.CvBridge()
        self.lock = threading.Lock()  # callbacks and the timer run in different threads
        self.arrival, self.standing = rospy.get_time(), True
        self.publisher = rospy.Publisher("motor_output", Twist, queue_size=1)
        self.stop_notice = StopNotice()
        self.picture = rospy.Publisher("~picture", Image, queue_size=1)
        self.images = rospy.Subscriber(
            "camera/image_raw", Image, self.take_image, queue_size=1, buff_size=2**24
        )
        self.timer = rospy.Timer(rospy.Duration(CHECK_PERIOD), self.check_images, reset=True)

    def take_image(self, msg):
        image = picture_of(msg)
        if image is None:
            return
        with self.lock:
            self.arrival, self.standing = rospy.get_time(), False
            before = self.driver.state
            line = find_line(image, self.driver.settings, self.driver.lateral)
            command = self.driver.drive(msg.header.stamp.to_sec(), line.ground)
            self.send(command.speed, command.steering_angle)
        if command.state != before:
            self.say(command.state)
        if self.picture.get_num_connections() > 0:
            self.show(image, line, command, msg.header)

    def say(self, state):
        if state == FOLLOWING:
            if not self.stop_notice.is_on:  # else it has said that the car stands
                rospy.loginfo("following the line")
        elif state == SEARCHING:
            side = "left" if self.driver.lateral > 0 else "right"
            rospy.logwarn("line lost: turning to the %s, where it was seen last", side)
        elif state == STOPPED:
            rospy.logerr(
                "line lost for %g s: standing still until a line is in sight",
                self.driver.settings.search_time,
            )

    def show(self, image, line, command, header):
        for column, row in line.pixels:
            cv2.circle(image, (round(column), round(row)), 5, (0, 0, 255), -1)
        text = f"{command.state} {command.speed:.2f} m/s {command.steering_angle:+.2f} rad"
        text += f"  {100 * self.driver.error:+.1f} cm"
        cv2.putText(image, text, (10, 30), cv2.FONT_HERSHEY_SIMPLEX, 0.8, (0, 0, 255), 2)
        self.picture.publish(self.bridge.cv2_to_imgmsg(image, "bgr8", header))

    def check_images(self, _event):
        """Stand still when images stop coming."""
        with self.lock:
            late = rospy.get_time() - self.arrival > self.driver.settings.image_timeout
            if late and not self.standing:
                rospy.logwarn("no images on %s: standing still", self.images.resolved_name)
                self.driver.halt()
                self.send(0.0, 0.0)
                self.standing = True

    def send(self, speed, angle):
        message = Twist()
        message.linear.x, message.angular.z = speed, angle
        self.publisher.publish(message)

    def change(self, settings):
        with self.lock:
            self.driver.settings = settings

    def stop(self):
        """Stop the car for good: no image starts it again."""
        self.timer.shutdown()
        self.images.unregister()
        with self.lock:
            self.send(0.0, 0.0)
        time.sleep(FLUSH_TIME)


def main():
    start_node("lane_follow")
    ending = Ending()
    follow = LaneFollow(read_settings(LaneSettings, "lane_follow.yaml"))
    serve_settings(follow.driver.settings, checked, follow.change)
    ending.asked.wait()
    follow.stop()
    ending.done()


if __name__ == "__main__":
    main()
