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
from geometry_msgs.msg import Pose, Twist
from nav_msgs.msg import Odometry
from racecar_description.track.closed_line import load_track
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Empty, EmptyResponse

SPEED = 0.15  # m/s, simulated
FRAME_RATE_HZ = 30
# s, wall, that a frame in lockstep waits for its command: some never come, others must
MUTE_TIME, ANSWER_TIME = 1.0, 30.0
DELAY = 1.5  # s, wall, from the odometry to the image, of one that delays


class FakeSimulator:
    """Drives along the line; `behaviour` says what goes wrong, and after how many m.

    The seed is the car's distance from the line in cm more.
    """

    def __init__(self, behaviour: str, after: float, factor: float):
        package = rospkg.RosPack().get_path("evaluation")
        self._track = load_track(f"{package}/tracks/course.yaml")
        self._behaviour, self._after, self._factor = behaviour, after, factor
        self._asked = rospy.get_param("~")
        self._running, self._answered = threading.Event(), threading.Event()
        if not self._asked["paused"]:
            self._running.set()
        self.time = 0.0

    @property
    def pose(self) -> Pose:
        """Where the car is at the present time."""
        s, left = max(0.0, self.time - 0.5) * SPEED, 0.03 + self._asked["seed"] / 100
        if s > self._after and self._behaviour == "stalls":
            s = self._after
        if s > self._after and self._behaviour == "leaves":
            left += s - self._after
        x, y, heading = self._track.pose(s)
        pose = Pose()
        pose.position.x, pose.position.y = x - left * np.sin(heading), y + left * np.cos(heading)
        pose.orientation.z, pose.orientation.w = np.sin(heading / 2), np.cos(heading / 2)
        return pose

    def state(self, _request: object) -> GetModelStateResponse:
        """Gazebo's answer on where the car is."""
        while self._behaviour == "hangs" and self.time * SPEED > self._after:
            time.sleep(0.1)
        reply = GetModelStateResponse(success=True, pose=self.pose)
        reply.header.stamp = rospy.Time.from_sec(self.time)
        return reply

    def world(self, _request: object) -> GetWorldPropertiesResponse:
        """Gazebo's answer on what is there."""
        models = ["ground_plane", "turtlebot3_waffle"]
        empty = self._behaviour == "no_car"
        return GetWorldPropertiesResponse(self.time, models[: 1 if empty else 2], True, True, "")

    def unpause(self, _request: object) -> EmptyResponse:
        """Let time begin."""
        self._running.set()
        return EmptyResponse()

    def hear(self, _command: Twist) -> None:
        """The follower's answer to a picture."""
        self._answered.set()

    def run(self) -> None:
        """Advance time and send pictures until shutdown."""
        info = rospy.Publisher("/camera/rgb/camera_info", CameraInfo, queue_size=10)
        images = rospy.Publisher("/camera/rgb/image_raw", Image, queue_size=1)
        odometry = rospy.Publisher("/odom", Odometry, queue_size=1000)  # not one is lost
        image, lockstep = self._picture(), bool(self._asked["lockstep"])
        answer_time = MUTE_TIME if self._behaviour == "mute" else ANSWER_TIME
        self._running.wait()
        while not rospy.is_shutdown():
            if not lockstep:
                time.sleep(1 / FRAME_RATE_HZ / self._factor)
            if self._behaviour == "pauses" and self.time * SPEED > self._after:
                time.sleep(0.1)
                continue
            self.time += 1 / FRAME_RATE_HZ
            image.header.stamp = rospy.Time.from_sec(self.time)
            moved = Odometry(header=image.header)
            moved.pose.pose = self.pose
            odometry.publish(moved)
            if "delays" in self._behaviour and self.time * SPEED > self._after:
                time.sleep(DELAY)
            self._answered.clear()
            info.publish(CameraInfo(header=image.header))
            images.publish(image)
            if lockstep and not self._answered.wait(answer_time):
                rospy.logwarn_throttle(10.0, f"lockstep: no message on {self._asked['lockstep']}")

    def _picture(self) -> Image:
        width, height = self._asked["camera_width"], self._asked["camera_height"]
        rospy.loginfo("asked for %s", self._asked)
        picture = np.full((height, width, 3), 10, np.uint8)
        picture[:, width // 2 - 2 : width // 2 + 2] = (255, 255, 0)
        return Image(
            height=height, width=width, encoding="rgb8", step=3 * width, data=picture.tobytes()
        )


def main() -> None:
    arguments = rospy.myargv(sys.argv)
    rospy.init_node("gazebo")
    fake = FakeSimulator(arguments[1], float(arguments[2]), float(arguments[3]))
    threading.Thread(target=fake.run, daemon=True).start()
    rospy.Service("~get_model_state", GetModelState, fake.state)
    rospy.Service("~get_world_properties", GetWorldProperties, fake.world)
    rospy.Service("~unpause_physics", Empty, fake.unpause)
    rospy.Subscriber("/cmd_vel", Twist, fake.hear, tcp_nodelay=True)
    rospy.spin()


if __name__ == "__main__":
    main()
