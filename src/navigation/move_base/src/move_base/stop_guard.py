"""The process that stops the robot when move_base has ended, for whatever reason.

The simulated drives, like upstream's and many real ones, keep the last commanded velocity; a killed
node cannot cancel it. This process holds the other end of a pipe: each line says whether the robot
is being driven, and if the pipe closes while it is, zero velocity is published.

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
AGAIN = 0.05  # s of wall time between two zero commands
ZEROS = 8     # several, in case another node of the same name sends a last command


def main() -> None:
    """Runs until standard input ends."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # it ends by itself, after move_base
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
