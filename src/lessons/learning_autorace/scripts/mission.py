#!/usr/bin/env python3
"""Controls the lights and the bar, and parks a robot, like the race's own mission node.

模仿比赛的任务节点：控制红绿灯和栏杆，停放一辆车。
"""

import math
import random
import sys
from pathlib import Path

import rospkg
import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel, SpawnModel
from geometry_msgs.msg import Pose

ROBOT = "autorace"
BAR = -1.72, 0.56  # m
NEAR_BAR = 0.8  # m: within this the wait starts  从这里开始计时
OPEN_AT_ONCE = 0.2  # share of the seeds  不用等的比例
BAYS = {"east": (0.755, 0.8), "west": (0.205, 0.8)}  # m, centres of the bays  车位中心
TICK = 0.2  # s, between two updates
YELLOW = 2.0  # s


class Mission:
    def __init__(self, seed):
        package = Path(rospkg.RosPack().get_path("turtlebot3_gazebo"))
        self.models = package / "models" / "turtlebot3_autorace_2020"
        draw = random.Random(seed)
        red, green = draw.uniform(4.0, 8.0), draw.uniform(8.0, 12.0)  # s
        self.light = {"red": red, "green": green, "yellow": YELLOW}
        self.begin = draw.uniform(-YELLOW, red)  # s: first it is yellow or red
        self.bar_wait = draw.uniform(4.0, 12.0) if draw.random() > OPEN_AT_ONCE else 0.0  # s
        self.bar_opens = math.inf  # s
        self.bay = draw.choice(sorted(BAYS))
        self.shown = {}
        self.spawn = rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)
        self.delete = rospy.ServiceProxy("/gazebo/delete_model", DeleteModel)
        self.spawn.wait_for_service()
        rospy.Subscriber("/gazebo/model_states", ModelStates, self.watch, queue_size=1)

    def park(self):
        """Park a robot in one of the bays.  在一个车位停一辆车。"""
        text = self.text("turtlebot3_burger").replace("<static>0", "<static>1")
        pose = Pose()
        pose.position.x, pose.position.y = BAYS[self.bay]
        pose.orientation.w = 1.0
        self.spawn("turtlebot3_burger", text, "", pose, "world")

    def show(self, kind, name):
        """Replace the last model of this kind by another.  换一个模型。"""
        if self.shown.get(kind) == name:
            return
        if kind in self.shown:
            self.delete(self.shown[kind])
        self.shown[kind] = name
        self.spawn(name, self.text(name), "", Pose(), "world")

    def watch(self, states):
        """Open the bar a while after the robot's arrival.  机器人靠近一会儿后栏杆抬起。"""
        if ROBOT in states.name and math.isinf(self.bar_opens):
            place = states.pose[states.name.index(ROBOT)].position
            if math.dist((place.x, place.y), BAR) < NEAR_BAR:
                self.bar_opens = rospy.get_time() + self.bar_wait

    def text(self, name):
        return (self.models / name / "model.sdf").read_text(encoding="utf-8")

    def work(self, _event=None):
        """Show the current lamp and bar.  显示现在的灯和栏杆。"""
        now = rospy.get_time()
        is_open = self.bar_wait == 0.0 or now >= self.bar_opens
        try:
            self.show("light", f"traffic_light_{phase(self.light, now + self.begin)}")
            self.show("bar", "traffic_bar_up" if is_open else "traffic_bar_down")
        except (rospy.ServiceException, rospy.ROSException) as error:  # the simulator has ended
            if not rospy.is_shutdown():
                rospy.logwarn_throttle(5.0, f"no light and no bar: {error}")


def phase(lengths, now):
    """The index of the phase at this time, s; `lengths` are in s.  现在是哪一段。"""
    now %= sum(lengths.values())
    for name, length in lengths.items():
        if now < length:
            return name
        now -= length
    return name


def main():
    rospy.init_node("mission_control")
    try:
        mission = Mission(rospy.get_param("~seed", 0))
        mission.park()
    except (rospy.ServiceException, rospy.ROSException) as error:
        sys.exit(None if rospy.is_shutdown() else f"mission_control: {error}")
    mission.work()
    rospy.Timer(rospy.Duration(TICK), mission.work, reset=True)
    rospy.spin()


if __name__ == "__main__":
    main()
