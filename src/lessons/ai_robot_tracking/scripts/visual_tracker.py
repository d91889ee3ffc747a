#!/usr/bin/env python3
"""Drives up to the largest red object in sight, with the tutorial's plain P controller.

朝视野里最大的红色物体开过去：教程里的比例控制。
"""

import cv2
import rospy
from ai_robot_tracking.page_law import PageSettings, largest_blob, page_command
from ai_robot_tracking.parameters import read_settings
from ai_robot_tracking.tracker_node import TrackerNode


class VisualTracker:
    """Keeps the last detection, to draw it."""

    def __init__(self, settings):
        self.settings, self.blob = settings, None

    def drive(self, picture, _time):
        before, self.blob = self.blob, largest_blob(picture, self.settings)
        if (before is None) != (self.blob is None):
            rospy.loginfo("target in sight" if self.blob else "nothing red in sight: turning")
        return page_command(self.blob, picture.shape[1], self.settings)

    def mark(self, picture, command):
        if self.blob is not None:
            centre = round(self.blob.column), round(self.blob.row)
            cv2.circle(picture, centre, round(self.blob.radius), (0, 255, 255), 2)
            cv2.circle(picture, centre, 4, (255, 255, 255), -1)
        text = f"{command[0]:.2f} m/s {command[1]:+.2f} rad/s"
        cv2.putText(picture, text, (10, 26), cv2.FONT_HERSHEY_SIMPLEX, 0.7, (0, 255, 255), 2)


def main():
    rospy.init_node("visual_tracker")
    tracker = VisualTracker(read_settings(PageSettings, "visual_tracker"))
    TrackerNode(tracker.settings.image_timeout, tracker.drive, tracker.mark)
    rospy.spin()


if __name__ == "__main__":
    main()
