#!/usr/bin/env python3
"""visual_tracker.py with more: PID keeps a distance, a search, frozen images, live parameters.

比 visual_tracker.py 多出：用 PID 保持距离；丢失后先朝最后看到的一侧找；识别卡住的图像；
参数可在运行时修改。
"""

import cv2
import rospy
from ai_robot_tracking.follower import Follower, FollowerSettings
from ai_robot_tracking.parameters import offer_settings, read_settings
from ai_robot_tracking.red_target import all_red
from ai_robot_tracking.tracker_node import TrackerNode


class VisualTrackerPid:
    """Passes images to the follower and logs what it does."""

    def __init__(self, settings):
        self.follower = Follower(settings)
        self.node = TrackerNode(settings.image_timeout, self.drive, self.mark, self.fills,
                                self.follower.halt)
        offer_settings(settings, self.change)

    def change(self, settings):
        with self.node.lock:
            self.follower.settings = settings
            self.node.image_timeout = settings.image_timeout

    def drive(self, picture, time):
        before = self.follower.state
        command = self.follower.drive(picture, time)
        if self.follower.state != before:
            rospy.loginfo("%s", self.follower.state)
        return command

    def fills(self, picture):
        return all_red(picture, self.follower.settings.colour)

    def mark(self, picture, command):
        seen = self.follower.seen
        text = f"{self.follower.state} {command[0]:+.2f} m/s {command[1]:+.2f} rad/s"
        if seen is not None:
            blob = seen.blob
            corner = blob.left + blob.width, blob.top + blob.height
            cv2.rectangle(picture, (blob.left, blob.top), corner, (0, 255, 255), 2)
            text += f"  {seen.distance:.2f} m"
        cv2.putText(picture, text, (10, 26), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (0, 255, 255), 2)


def main():
    rospy.init_node("visual_tracker_pid")
    VisualTrackerPid(read_settings(FollowerSettings, "visual_tracker_pid"))
    rospy.spin()


if __name__ == "__main__":
    main()
