#!/usr/bin/env python3
"""Stands in for the simulator in tests: a car on rails beside the line, many times too fast."""

import sys
import threading
import time

import numpy as np
import rospkg
import rospy
from gazebo_msgs.srv import (
    GetModelState,
    GetModelStateResponse,
    GetWorldProperties,
    GetWorldPropertiesResponse,
)
from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo, Image

from evaluation.track import load_track

SPEED = 0.15  # m/s, simulated
FRAME_RATE_HZ = 30


class FakeSimulator:
    """Drives along the line; `behaviour` says what goes wrong, and after how many m."""

    def __init__(self, behaviour: str, after: float, factor: float):
        package = rospkg.RosPack().get_path("evaluation")
        self._track = load_track(f"{package}/tracks/course.yaml")
        self._behaviour, self._after, self._factor = behaviour, after, factor
        self.time = 0.0

    def pose(self) -> tuple[float, float, float]:
        """x, y, yaw at the present time."""
        s, left = max(0.0, self.time - 0.5) * SPEED, 0.03
        if s > self._after and self._behaviour == "stalls":
            s = self._after
        if s > self._after and self._behaviour == "leaves":
            left += s - self._after
        x, y, heading = self._track.pose(s)
        return x - left * np.sin(heading), y + left * np.cos(heading), heading

    def state(self, _request: object) -> GetModelStateResponse:
        """Gazebo's answer on where the car is."""
        while self._behaviour == "hangs" and self.time * SPEED > self._after:
            time.sleep(0.1)
        reply = GetModelStateResponse(success=True)
        reply.header.stamp = rospy.Time.from_sec(self.time)
        x, y, yaw = self.pose()
        reply.pose.position.x, reply.pose.position.y = x, y
        reply.pose.orientation.z, reply.pose.orientation.w = np.sin(yaw / 2), np.cos(yaw / 2)
        return reply

    def world(self, _request: object) -> GetWorldPropertiesResponse:
        """Gazebo's answer on what is there."""
        models = ["ground_plane", "turtlebot3_waffle"]
        empty = self._behaviour == "no_car"
        return GetWorldPropertiesResponse(self.time, models[: 1 if empty else 2], True, True, "")

    def run(self) -> None:
        """Advance time and send pictures until shutdown."""
        info = rospy.Publisher("/camera/rgb/camera_info", CameraInfo, queue_size=10)
        images = rospy.Publisher("/camera/rgb/image_raw", Image, queue_size=1)
        picture = np.full((270, 480, 3), 10, np.uint8)
        picture[:, 236:244] = (255, 255, 0)
        image = Image(height=270, width=480, encoding="rgb8", step=1440, data=picture.tobytes())
        while not rospy.is_shutdown():
            time.sleep(1 / FRAME_RATE_HZ / self._factor)
            if self._behaviour == "pauses" and self.time * SPEED > self._after:
                continue
            self.time += 1 / FRAME_RATE_HZ
            image.header.stamp = rospy.Time.from_sec(self.time)
            info.publish(CameraInfo(header=image.header))
            images.publish(image)


def main() -> None:
    arguments = rospy.myargv(sys.argv)
    rospy.init_node("gazebo")
    fake = FakeSimulator(arguments[1], float(arguments[2]), float(arguments[3]))
    threading.Thread(target=fake.run, daemon=True).start()
    rospy.Service("~get_model_state", GetModelState, fake.state)
    rospy.Service("~get_world_properties", GetWorldProperties, fake.world)
    rospy.Publisher("/cmd_vel", Twist, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
