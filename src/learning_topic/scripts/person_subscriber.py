#!/usr/bin/env python3
"""Receive messages of a custom type.  订阅自定义消息。"""

import rospy

from learning_topic.msg import Person


def person_callback(msg):
    rospy.loginfo("received: %s, age %d, sex %d", msg.name, msg.age, msg.sex)


def main():
    rospy.init_node("person_subscriber", anonymous=True)
    rospy.Subscriber("/person_info", Person, person_callback, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
