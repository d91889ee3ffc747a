#!/usr/bin/env python3
"""Global, relative and private names, and remapping on the command line.  三种名称。"""

import rospy
from std_msgs.msg import String


def main():
    rospy.init_node("names")
    for name in ("/chatter", "chatter", "~chatter"):  # global, relative, private  全局、相对、私有
        publisher = rospy.Publisher(name, String, queue_size=1)
        rospy.loginfo("%s -> %s", name, publisher.resolved_name)
    rospy.loginfo("~speed = %s", rospy.get_param("~speed", "not set"))


if __name__ == "__main__":
    main()
