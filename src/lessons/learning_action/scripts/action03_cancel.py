#!/usr/bin/env python3
"""Cancel a goal that takes too long.  目标耗时太长就取消。"""

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from learning_action.msg import AddIntsAction, AddIntsGoal

PATIENCE = 1.0  # s


def main():
    rospy.init_node("action_cancel")
    client = actionlib.SimpleActionClient("addInts", AddIntsAction)
    if not client.wait_for_server():
        return  # Ctrl-C while waiting  等待时按下 Ctrl-C
    client.send_goal(AddIntsGoal(num=100))  # 10 s of work  需要 10 秒
    if not client.wait_for_result(rospy.Duration(PATIENCE)):
        rospy.loginfo("not done after %.0f s: cancel", PATIENCE)
        client.cancel_goal()
        client.wait_for_result()  # until the server confirms  等服务端确认
    rospy.loginfo("%s, result %d", GoalStatus.to_string(client.get_state()),
                  client.get_result().result)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
