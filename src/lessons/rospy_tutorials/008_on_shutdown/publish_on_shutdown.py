#!/usr/bin/env python3
"""Says a last word when it is ended.  节点结束时再发布一条消息。"""

import rospy
from std_msgs.msg import String


def main():
    publisher = rospy.Publisher("chatter", String, queue_size=10)
    rospy.init_node("publish_on_shutdown")
    # Called at Ctrl-C, before the topics are closed.  按下 Ctrl-C 时、话题关闭之前调用
    rospy.on_shutdown(lambda: publisher.publish("I'm dead!"))
    rospy.loginfo("end me by Ctrl-C; rostopic echo /chatter shows the last word")
    rospy.spin()


if __name__ == "__main__":
    main()
