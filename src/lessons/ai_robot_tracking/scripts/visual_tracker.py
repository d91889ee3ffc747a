#!/usr/bin/env python3
"""Drives up to the largest red object in sight, with the tutorial's plain P controller.

朝视野里最大的红色物体开过去：教程里的比例控制。

It never stops before the target. Beyond the tutorial, TrackerNode stops the car when images are
unusable and at the end.  图像异常或节点结束时，TrackerNode 让车停下。
"""

from dataclasses import dataclass

import cv2
import rospy
from ai_robot_tracking.parameters import read_settings
from ai_robot_tracking.red_target import RedSettings, all_red, find_blobs, red_mask
from ai_robot_tracking.tracker_node import TrackerNode
from node_basics.settings import number


@dataclass(frozen=True)
class PageSettings(RedSettings):
    """Section visual_tracker of the parameter file: colour bounds, and the law's parameters."""

    turn_gain: float = number(0, 1, "rad/s per px from the middle")
    straight_error: float = number(0, 2000, "px; less error: the target is straight ahead")
    near_radius: float = number(0, 2000, "px")
    far_radius: float = number(0, 2000, "px")
    fast_speed: float = number(0, 2, "m/s, if the target is ahead and larger than near_radius")
    far_speed: float = number(0, 2, "m/s, if the target is smaller than far_radius")
    slow_speed: float = number(0, 2, "m/s, otherwise")
    search_turn: float = number(0, 5, "rad/s, if nothing red is in sight")
    small_turn: float = number(0, 5, "rad/s, if the red blob has least_radius or less")
    image_timeout: float = number(0.05, 60, "s without a new image until it stops")


def largest_blob(picture, settings):
    """The largest red blob in a BGR image (rows, columns, 3), however small; or None."""
    blobs = find_blobs(red_mask(picture, settings.colour), 0)
    return blobs[0] if blobs else None


def page_command(blob, width, settings):
    """Speed (m/s) and turn rate (rad/s, left positive) for a blob; `width`: of the image, px."""
    if blob is None:
        return 0.0, settings.search_turn
    if blob.radius <= settings.least_radius:
        return 0.0, settings.small_turn
    error = blob.column - width / 2  # px, positive on the right
    if abs(error) < settings.straight_error and blob.radius > settings.near_radius:
        speed = settings.fast_speed
    elif blob.radius < settings.far_radius:
        speed = settings.far_speed
    else:
        speed = settings.slow_speed
    return speed, -settings.turn_gain * error


class VisualTracker:
    """Keeps the last detection, to draw it."""

    def __init__(self, settings):
        self.settings, self.blob = settings, None

    def drive(self, picture, _time):
        before, self.blob = self.blob, largest_blob(picture, self.settings)
        if (before is None) != (self.blob is None):
            rospy.loginfo("target in sight" if self.blob else "nothing red in sight: turning")
        return page_command(self.blob, picture.shape[1], self.settings)

    def fills(self, picture):
        return all_red(picture, self.settings.colour)

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
    TrackerNode(tracker.settings.image_timeout, tracker.drive, tracker.mark, tracker.fills)
    rospy.spin()


if __name__ == "__main__":
    main()
