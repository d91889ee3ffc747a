#!/usr/bin/env python3
"""Sends the car to a pose on the map: send_goal.py X Y [DEGREES].  把小车派到地图上的一个位置。"""

import math
import sys
import time

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import OccupancyGrid

SOON = 2  # s, in which a move_base that runs answers  正在运行的 move_base 会在此时间内应答
USAGE = "rosrun nav_demo send_goal.py X Y [DEGREES]   m on the map; e.g. send_goal.py 1.5 -1.5 90"
OCCUPIED = 65  # of 100  占据的下限
WAIT = 30  # s to wait for move_base  等 move_base 应答的秒数


def place_of(words):
    """x and y, m, and degrees, from the command line.  读取命令行里的位置和角度。"""
    if {"-h", "--help"} & {*words}:
        print(USAGE)
        sys.exit(0)
    try:
        x, y, degrees = (float(word) for word in (words if len(words) == 3 else [*words, 0]))
        if not all(map(math.isfinite, (x, y, degrees))):
            raise ValueError
    except ValueError:
        place = " ".join(words)
        sys.exit(f"which place is {place!r}? e.g. rosrun nav_demo send_goal.py 1.5 -1.5 90")
    return x, y, degrees


def goal_at(x, y, yaw):
    """A goal in the frame map; m, rad.  地图坐标系里的目标。"""
    goal = MoveBaseGoal()
    goal.target_pose.header.frame_id = "map"
    goal.target_pose.header.stamp = rospy.Time.now()
    goal.target_pose.pose.position.x = x
    goal.target_pose.pose.position.y = y
    # A quaternion about z uses half the angle.  绕 z 轴的四元数用半角
    goal.target_pose.pose.orientation.z = math.sin(yaw / 2)
    goal.target_pose.pose.orientation.w = math.cos(yaw / 2)
    return goal


def wait_for_clock():
    """Otherwise a wait of 30 s from time 0 ends at once.  否则从 0 开始的等待立刻超时。"""
    began = time.monotonic()
    while rospy.get_time() == 0 and not rospy.is_shutdown():
        time.sleep(0.1)
        if time.monotonic() - began > 2:
            rospy.loginfo_once("waiting for /clock: is the simulator running?")


def wait_for_move_base(client):
    """Exits with one line if nobody answers.  没有应答时，输出一行后退出。"""
    if client.wait_for_server(rospy.Duration(SOON)):
        return
    if not rospy.is_shutdown():
        rospy.loginfo(f"waiting for move_base, for {WAIT} s: roslaunch nav_demo nav05_test.launch")
    if not client.wait_for_server(rospy.Duration(WAIT)):
        sys.exit("stopped before the goal was sent" if rospy.is_shutdown() else
                 "nobody answers as move_base: roslaunch nav_demo nav05_test.launch")


def tell_progress(feedback):
    """Called repeatedly while driving.  途中反复调用。"""
    place = feedback.base_position.pose.position
    rospy.loginfo_throttle(2, f"the car is at {place.x:.2f}, {place.y:.2f}")


def fault_on_map(grid, x, y):
    """Why no car can be there, m; empty if it may; grid: OccupancyGrid.  为什么到不了这个位置。"""
    info = grid.info
    west, south = info.origin.position.x, info.origin.position.y
    column, row = (math.floor(way / info.resolution) for way in (x - west, y - south))
    if not (0 <= column < info.width and 0 <= row < info.height):
        east, north = (start + cells * info.resolution
                       for start, cells in ((west, info.width), (south, info.height)))
        return (f"{x:g}, {y:g} is off the map, which has x {west:.1f} to {east:.1f} m and "
                f"y {south:.1f} to {north:.1f} m")
    if grid.data[row * info.width + column] >= OCCUPIED:  # -1: unknown, perhaps free  -1 为未知
        return f"the map has an obstacle at {x:g}, {y:g}"
    return ""


def newest_map():
    """None where the navigation has none.  没有地图时为 None。"""
    try:
        return rospy.wait_for_message("map", OccupancyGrid, SOON)
    except rospy.ROSException:
        if rospy.is_shutdown():  # Ctrl-C meanwhile  此时按了 Ctrl-C
            sys.exit("stopped before the goal was sent")
        return None


def refuse_at_once(x, y):
    """Exits with one line, where move_base would try for a minute.  去不了的位置立刻拒绝。"""
    grid = newest_map()
    fault = fault_on_map(grid, x, y) if grid else ""
    if fault:
        sys.exit(f"the goal was not sent: {fault}")


def tell_outcome(client, x, y):
    """Log how it ended; True if the goal was reached.  输出结果。"""
    text = client.get_goal_status_text()
    rospy.loginfo(text)
    if "valid plan" in text:
        rospy.loginfo(f"no way leads to {x:g}, {y:g}: the map does not know it, or it is behind "
                      "a wall or too near to one")
    return client.get_state() == GoalStatus.SUCCEEDED


def stop_if_driving(client):
    """Stop the car at Ctrl-C.  Ctrl-C 时让小车停下。"""
    if client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
        client.cancel_goal()


def main():
    x, y, degrees = place_of(rospy.myargv(sys.argv)[1:])  # without ROS's  去掉 ROS 自己的参数
    rospy.init_node("send_goal", anonymous=True)  # a later goal replaces it  后发的目标取代它
    wait_for_clock()
    if rospy.is_shutdown():  # Ctrl-C: the master may have ended  此时可能已没有 master
        sys.exit("stopped before the goal was sent")
    client = actionlib.SimpleActionClient("move_base", MoveBaseAction)
    wait_for_move_base(client)
    refuse_at_once(x, y)
    client.send_goal(goal_at(x, y, math.radians(degrees)), feedback_cb=tell_progress)
    rospy.on_shutdown(lambda: stop_if_driving(client))
    client.wait_for_result()
    if rospy.is_shutdown():
        sys.exit("stopped on the way: the goal is cancelled")
    sys.exit(0 if tell_outcome(client, x, y) else 1)


if __name__ == "__main__":
    main()
