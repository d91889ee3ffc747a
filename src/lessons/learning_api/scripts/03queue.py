#!/usr/bin/env python3
"""queue_size with a slow subscriber: which messages are dropped.  订阅者太慢时，队列丢掉旧消息。"""

import sys

import rospy
from std_msgs.msg import Int32

SLOW = 0.3  # s to process a message


def number_callback(message):
    rospy.loginfo("number %d", message.data)
    rospy.sleep(SLOW)


def main():
    rospy.init_node("queue")
    size = rospy.get_param("~size", 1)
    if type(size) is not int or size < 1:
        sys.exit(f"03queue.py: ~size must be a whole number from 1 on, not {size!r}")
    rospy.Subscriber("number", Int32, number_callback, queue_size=size)
    publisher = rospy.Publisher("number", Int32, queue_size=100)
    while publisher.get_num_connections() == 0:  # earlier messages would be lost  否则会丢
        rospy.sleep(0.01)
    for number in range(10):  # ten per second, three times too fast  发得太快
        publisher.publish(number)
        rospy.sleep(0.1)
    rospy.sleep(SLOW * (size + 1))


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
