#!/usr/bin/env python3
"""Publish messages of a custom type.  发布自定义消息。"""

import rospy

from learning_topic.msg import Person

RATE_HZ = 10


def main():
    rospy.init_node("person_publisher", anonymous=True)
    publisher = rospy.Publisher("/person_info", Person, queue_size=10)
    person = Person(name="Tom", age=18, sex=Person.male)
    rate = rospy.Rate(RATE_HZ)
    while not rospy.is_shutdown():
        publisher.publish(person)
        rospy.loginfo("published: %s, age %d, sex %d", person.name, person.age, person.sex)
        rate.sleep()


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
