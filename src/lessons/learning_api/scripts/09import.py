#!/usr/bin/env python3
"""Import a module from the same folder.  导入同目录下的模块。"""

import rospy
from circle import area  # circle.py; Python looks in this script's folder first  先找本脚本所在目录


def main():
    rospy.init_node("import_module")
    rospy.loginfo("a circle of radius 2 m has %.2f m2", area(2.0))


if __name__ == "__main__":
    main()
