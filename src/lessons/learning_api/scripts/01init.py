#!/usr/bin/env python3
"""The options of init_node.  init_node 的参数。"""

import rospy


def main():
    # anonymous: a number behind the name, so that two of them can run.  名字后加随机数，可重复启动
    # log_level: debug lines are shown too.  显示 debug 日志
    # disable_signals: Ctrl-C is KeyboardInterrupt, as in plain Python.  Ctrl-C 交给 Python 处理
    rospy.init_node("init", anonymous=True, log_level=rospy.DEBUG, disable_signals=True)
    try:
        rospy.logdebug("my name is %s", rospy.get_name())
        while not rospy.is_shutdown():  # spin() would keep the interrupt  spin() 会自己处理
            rospy.sleep(0.1)
    except KeyboardInterrupt:
        print("Ctrl-C came as KeyboardInterrupt")


if __name__ == "__main__":
    main()
