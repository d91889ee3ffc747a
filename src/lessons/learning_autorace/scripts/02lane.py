#!/usr/bin/env python3
"""Lesson 2: keep the lane, yellow on the left, white on the right.  第二课：沿车道行驶。

Lessons 3 to 7 import this one: their missions interrupt it.  后面几课导入这一课，由任务打断它。
"""

import math
import time
from dataclasses import dataclass, field

import cv2
import cv_bridge
import numpy as np
import rospy
from geometry_msgs.msg import Twist
from learning_autorace.ground import (
    AHEAD,
    calibration_of_parameter,
    compensate,
    find_lane,
    floor_maps,
    laser_points,
)
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, LaserScan

SPEED, SLOW = 0.15, 0.06  # m/s
KP, KD = 1.0, 0.05  # gain on the arc to the aim; s
MOST_TURN = 1.5  # rad/s
REACH, LENGTH = 0.38, 0.10  # m ahead of and behind the base: a barrier there is beside the robot
BESIDE = 0.16  # m to either side of the lane's middle: a barrier there is in the lane
CLEAR = 0.12  # m from the robot's middle to a barrier


@dataclass
class Seen:
    """The robot's sensor data at an image's arrival.  收到一帧图像时的全部数据。"""

    time: float  # s
    image: np.ndarray  # (h, w, 3) BGR
    view: np.ndarray  # the ground from above, BGR, compensated
    # (N, 2) m, the laser's hits: x ahead and y left of the base
    points: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    pose: tuple = (0.0, 0.0, 0.0)  # odometry: x, y in m, yaw in rad


class LaneKeeper:
    """PD control on the position of the lane's middle.  按车道中心做 PD 控制。"""

    def __init__(self, calibration):
        self.calibration = calibration
        self.reset()

    def reset(self):
        """Forget the lane: assume that it is straight ahead.  假定车道在正前方。"""
        self.centre, self.unseen = 0.0, 0  # m; number of images without a lane
        self.last = None  # m, s

    def look(self, view):
        """The lane's middle AHEAD, m to the left; the last one if it is not seen."""
        centre = find_lane(view, self.centre, self.calibration).centre(self.calibration.lane_width)
        self.unseen = 0 if centre is not None else self.unseen + 1
        self.centre = self.centre if centre is None else centre
        return self.centre

    def steer(self, aim, now):
        """Speed in m/s and turn rate in rad/s towards an aim, m to the left, at this time in s."""
        change = 0.0
        if self.last and now > self.last[1]:
            change = (aim - self.last[0]) / (now - self.last[1])
        self.last = aim, now
        speed = SPEED if self.unseen < 5 else SLOW
        turn = speed * 2 * (KP * aim + KD * change) / (AHEAD ** 2 + aim ** 2)
        return speed, max(-MOST_TURN, min(MOST_TURN, turn))


def between(aim, points):
    """The aim, m to the left, shifted so that the robot clears the barriers beside it.  绕开路障。

    `points` (N, 2): of the laser, m, x ahead and y left of the base.
    """
    aside = points[(points[:, 0] > -LENGTH) & (points[:, 0] < REACH), 1]
    left = aside[(aside > aim) & (aside < aim + BESIDE)]
    right = aside[(aside <= aim) & (aside > aim - BESIDE)]
    most, least = left.min(initial=np.inf) - CLEAR, right.max(initial=-np.inf) + CLEAR
    if least > most:
        return (least + most) / 2
    return min(max(aim, least), most)


class Driver:
    """Keeps the lane unless a mission commands: the first of the list, or the second, in case the
    first has nothing to do, such as an open bar.  任务没有命令时沿车道行驶。"""

    def __init__(self, calibration, missions=()):
        self.missions = [mission(calibration) for mission in missions]
        self.lane = LaneKeeper(calibration)

    def drive(self, seen):
        """Speed in m/s and turn rate in rad/s."""
        command = None
        for number, mission in enumerate(self.missions[:2]):
            command = mission.step(seen)
            if command is not None:
                self.missions = self.missions[number:]
                break
        self.missions = [each for each in self.missions if not each.done]
        if command and any(command):
            self.lane.reset()  # afterwards the robot is elsewhere
        aim = between(self.lane.look(seen.view), seen.points)
        return command or self.lane.steer(aim, seen.time)


class Node:
    """A command for each image.  每帧图像发一次速度指令。"""

    def __init__(self, calibration, missions):
        self.calibration, self.driver = calibration, Driver(calibration, missions)
        self.maps, self.bridge = None, cv_bridge.CvBridge()
        self.seen = Seen(0.0, np.empty(0), np.empty(0))
        self.commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("scan", LaserScan, self.take_scan, queue_size=1)
        rospy.Subscriber("odom", Odometry, self.take_odometry, queue_size=1)
        self.images = rospy.Subscriber("camera/image", Image, self.take_image, queue_size=1,
                                       buff_size=2**24)

    def take_scan(self, message):
        self.seen.points = laser_points(message)

    def take_odometry(self, message):
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        self.seen.pose = place.x, place.y, 2 * math.atan2(turn.z, turn.w)

    def take_image(self, message):
        try:
            image = self.bridge.imgmsg_to_cv2(message, desired_encoding="bgr8")
        except (TypeError, ValueError) as error:  # CvBridgeError; too few bytes, huge sizes
            rospy.logwarn_throttle(5.0, f"an image that cannot be used: {error}")
            return
        if self.maps is None:
            self.maps = floor_maps(image.shape[1], image.shape[0], self.calibration)
        self.seen.time, self.seen.image = message.header.stamp.to_sec(), image
        self.seen.view = compensate(cv2.remap(image, *self.maps, cv2.INTER_LINEAR),
                                    self.calibration.clip_percent)
        command = Twist()
        command.linear.x, command.angular.z = self.driver.drive(self.seen)
        self.commands.publish(command)

    def stop(self):
        """Stop before exiting: the robot keeps following the last command.  退出前停车。"""
        self.images.unregister()
        for _ in range(3):
            self.commands.publish(Twist())
            time.sleep(0.1)  # s of wall time: simulated time may be paused


def run(name, missions=()):
    """Run a node until Ctrl-C that keeps the lane and does these missions, in their order."""
    rospy.init_node(name)
    node = Node(calibration_of_parameter(), missions)
    rospy.on_shutdown(node.stop)
    rospy.spin()


def main():
    run("autorace_lane")


if __name__ == "__main__":
    main()
