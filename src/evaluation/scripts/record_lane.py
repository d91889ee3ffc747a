#!/usr/bin/env python3
"""Records the true poses of car and people: `record_lane.py _out:=FILE`; ends with the drive."""

import math
from pathlib import Path

import rospy
from lane_keeping.world.scenery import load_crossings
from nav_msgs.msg import Odometry

from evaluation.lane_encounters import CAR, Moment, line_of
from run_session.simulator import place_of


def main() -> None:
    rospy.init_node("record_lane")
    names = [f"pedestrian_{number}" for number in range(1, len(load_crossings().zebras) + 1)]
    with Path(rospy.get_param("~out")).open("w", encoding="utf-8", buffering=1) as file:
        topics = [("ground_truth", CAR), *((f"{name}/odom", name) for name in names)]
        for topic, name in topics:
            rospy.Subscriber(topic, Odometry, _write, (file, name), queue_size=1000)
        rospy.spin()


def _write(message: Odometry, where: tuple) -> None:
    file, name = where
    pose, twist = message.pose.pose, message.twist.twist.linear
    moment = Moment(message.header.stamp.to_sec(), *place_of(pose), math.hypot(twist.x, twist.y))
    if not file.closed:
        file.write(line_of(name, moment))


if __name__ == "__main__":
    main()
