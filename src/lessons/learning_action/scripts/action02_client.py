#!/usr/bin/env python3
"""An action client: send a goal, print the progress.  动作客户端：发送目标，查看进度和结果。"""

import sys

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from learning_action.msg import AddIntsAction, AddIntsGoal


def active_callback():
    rospy.loginfo("the server has begun")


def feedback_callback(feedback):
    rospy.loginfo("progress: %.0f %%", feedback.progress_bar * 100)


def done_callback(state, result):
    rospy.loginfo("%s, result %d", GoalStatus.to_string(state), result.result)


def main():
    # rospy takes _num:=20 for the parameter ~num.  参数要这样写
    for word in sys.argv[1:]:
        if ":=" not in word or word.startswith("num:="):
            sys.exit(f"action02_client.py: {word} is not read; type _num:=20 for the goal 20")
    rospy.init_node("action_client", anonymous=True)
    num = rospy.get_param("~num", 10)
    if type(num) is not int:
        sys.exit(f"action02_client.py: ~num must be a whole number, not {num!r}")
    client = actionlib.SimpleActionClient("addInts", AddIntsAction)
    rospy.loginfo("waiting for addInts")
    if not client.wait_for_server():
        return  # Ctrl-C while waiting  等待时按下 Ctrl-C
    goal = AddIntsGoal(num=num)
    client.send_goal(goal, done_callback, active_callback, feedback_callback)
    client.wait_for_result()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
