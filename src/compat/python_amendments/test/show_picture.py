#!/usr/bin/env python3
"""A learner's script, as it would be written for a screen: nothing in it knows of our windows."""

import cv2
import numpy as np
import rospy


def main():
    rospy.init_node("show_picture")
    picture = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)
    cv2.namedWindow("still", cv2.WINDOW_NORMAL)
    cv2.imshow("still", picture)
    while not rospy.is_shutdown():
        cv2.imshow("my mask", picture[:, :, 0] / 255.0)
        if cv2.waitKey(20) == 27:
            break
    cv2.destroyAllWindows()


if __name__ == "__main__":
    main()
