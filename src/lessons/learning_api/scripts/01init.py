#!/usr/bin/env python3
"""The options of init_node.  init_node 的参数。"""

import rospy


def main():
    # anonymous: adds a number to the name, so that two can run at once.  名字后加随机数，可重复启动
    # log_level: also show debug messages.  显示 debug 日志
    # disable_signals: Ctrl-C raises KeyboardInterrupt, as in plain Python.  Ctrl-C 交给 Python 处理
    rospy.init_node("init", anonymous=True, log_level=rospy.DEBUG, disable_signals=True)
    try:
        rospy.logdebug("my name is %s", rospy.get_name())
        while not rospy.is_shutdown():  # spin() would catch the interrupt  spin() 会自己处理
            rospy.sleep(0.1)
    except KeyboardInterrupt:
        print("Ctrl-C came as KeyboardInterrupt")


if __name__ == "__main__":
    main()
