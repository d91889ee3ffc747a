#!/usr/bin/env python3
"""Call a service of a custom type.  调用自定义类型的服务。"""

import rospy
from learning_service.srv import Person, PersonRequest


def main():
    rospy.init_node("person_client")
    rospy.loginfo("waiting for /show_person")
    rospy.wait_for_service("/show_person")  # until the server is running  等待服务端启动
    show_person = rospy.ServiceProxy("/show_person", Person)
    try:
        # The constants are part of the request, above the three dashes.  常量在请求部分定义
        response = show_person("Tom", 20, PersonRequest.male)
    except rospy.ServiceException as error:
        rospy.logerr("no answer: %s", error)
        return
    rospy.loginfo("show_person answers: %s", response.result)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while waiting  等待时按下 Ctrl-C
