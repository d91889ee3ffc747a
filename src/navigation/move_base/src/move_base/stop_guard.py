"""The process that stops the robot when move_base is gone, however it went.

The simulated drives, as upstream's and as many real ones, keep the last velocity that they were
told; a killed node cannot take it back. This process holds the other end of a pipe: a line says
whether the robot is being driven, and when the pipe ends while it is, zero is published.

    python3 -m move_base.stop_guard twist /cmd_vel __name:=move_base_stop_guard
"""

from __future__ import annotations

import signal
import sys
import time

import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from geometry_msgs.msg import Twist

MESSAGES = {"twist": Twist, "ackermann": AckermannDriveStamped}
DRIVEN, STANDING = "driven\n", "standing\n"
AGAIN = 0.05  # s of wall time between two zeros
ZEROS = 8     # in case that another node of the same name drove a last time meanwhile


def main() -> None:
    """Until the standard input ends."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # it ends with move_base, and after it
    arguments = rospy.myargv()
    kind = MESSAGES[arguments[1]]
    rospy.init_node("move_base_stop_guard", disable_signals=True, disable_rostime=True)
    publisher = rospy.Publisher(arguments[2], kind, queue_size=1)
    driven = False
    for line in sys.stdin:
        driven = line == DRIVEN
    for _ in range(ZEROS if driven else 0):
        publisher.publish(kind())
        time.sleep(AGAIN)
    rospy.signal_shutdown("move_base has ended")


if __name__ == "__main__":
    main()
