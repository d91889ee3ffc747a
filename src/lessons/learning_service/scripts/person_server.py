#!/usr/bin/env python3
"""Provide a service of a custom type.  提供自定义类型的服务。"""

import rospy
from learning_service.srv import Person, PersonResponse


def person_callback(request):
    rospy.loginfo("person: %s, age %d, sex %d", request.name, request.age, request.sex)
    return PersonResponse("OK")  # what the client gets  客户端收到的结果


def main():
    rospy.init_node("person_server")
    rospy.Service("/show_person", Person, person_callback)
    rospy.loginfo("ready for /show_person")
    rospy.spin()


if __name__ == "__main__":
    main()
