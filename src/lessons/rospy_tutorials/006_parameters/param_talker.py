#!/usr/bin/env python3
"""Reads, sets and deletes parameters, and publishes one of them.  读写和删除参数。"""

import rospy
from std_msgs.msg import String


def read():
    """The sentence to publish and its topic; prints what was read.  读参数。"""
    for name in ("/global_example", "utterance", "~topic_name"):  # global, relative, private
        rospy.loginfo("%s is %s", rospy.resolve_name(name), rospy.get_param(name))
    # The second argument is the default.  参数不存在时用默认值
    default = rospy.get_param("default_param", "default_value")
    rospy.loginfo("%s is %s", rospy.resolve_name("default_param"), default)
    gains = rospy.get_param("gains")  # a group is a dictionary  一组参数是字典
    utterance, topic = rospy.get_param("utterance"), rospy.get_param("~topic_name")
    fault = fault_of(utterance, topic, gains)
    if fault:
        rospy.logfatal(fault)
        raise SystemExit(1)
    rospy.loginfo("gains are %s, %s, %s", gains["P"], gains["I"], gains["D"])
    return utterance, topic


def fault_of(utterance, topic, gains):
    """Which parameter is of another type than it must be, in a line.  哪个参数的类型不对。"""
    for name, value, kind, wanted in (("utterance", utterance, str, "a text"),
                                      ("~topic_name", topic, str, "a text"),
                                      ("gains", gains, dict, "a group with P, I and D")):
        if not isinstance(value, kind):
            return f"the parameter {rospy.resolve_name(name)} must be {wanted}, not {value}"
    return ""


def write():
    """Sets some, deletes one, looks for one.  写参数、删除参数、查找参数。"""
    rospy.loginfo("setting parameters...")
    rospy.set_param("list_of_floats", [1.0, 2.0, 3.0, 4.0])
    rospy.set_param("bool_True", True)
    rospy.set_param("~private_bar", 1 + 2)
    rospy.set_param("to_delete", "baz")
    rospy.loginfo("...parameters have been set")
    rospy.delete_param("to_delete")
    rospy.loginfo("deleted %s parameter", rospy.resolve_name("to_delete"))
    # From this namespace upwards.  从当前命名空间逐级向上查找
    rospy.loginfo("found global_example parameter under key: %s",
                  rospy.search_param("global_example"))


def main():
    rospy.init_node("param_talker")
    try:
        utterance, topic = read()
    except KeyError as missing:
        rospy.logfatal("no parameter %s: roslaunch rospy_tutorials param_talker.launch sets them",
                       missing)
        raise SystemExit(1) from None
    write()
    publisher = rospy.Publisher(topic, String, queue_size=10)
    while not rospy.is_shutdown():
        publisher.publish(utterance)
        rospy.loginfo(utterance)
        rospy.sleep(1)


if __name__ == "__main__":
    try:
        main()
    except rospy.ROSInterruptException:
        pass  # Ctrl-C while sleeping  睡眠时按下 Ctrl-C
