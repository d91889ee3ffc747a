#!/usr/bin/env python3
"""motor_control_page.py with stops, limits, Ackermann steering and AckermannDriveStamped.

The car stops if no command comes for ~timeout, and when the node that sends commands ends: at once
if no other publisher is connected to that topic, else after ~timeout.
"""

import math
import threading
import time

import rospy
from ackermann_msgs.msg import AckermannDriveStamped
from car_control.motor import DriveCommand, Motor, MotorSettings, controller_commands
from car_control.node import Ending, read_settings, release, start_node
from geometry_msgs.msg import Twist
from node_basics.reconfigure import serve_settings
from node_basics.settings import checked
from std_msgs.msg import Bool, Float64

WAKE = 0.02  # s, wall: how often to check for a sender's end, whatever the clock does
STILL_CLOCK = 0.1  # s, wall, between repeated commands while simulated time is paused
FLUSH_TIME = 0.1  # s, wall: rospy's threads need this to send before the process ends


class MotorControl:
    """Sends each command at once, and repeats the last one at rate_hz."""

    def __init__(self, settings):
        self.motor = Motor(settings)
        self.lock = threading.Lock()  # callbacks run in different threads
        self.sent = DriveCommand(0.0, 0.0)
        self.next_time = self.sent_wall = -math.inf  # s, ROS time and wall time
        self.source = None  # the topic of the last command
        self.publishers = {
            name: rospy.Publisher(f"{settings.namespace}/{name}/command", Float64, queue_size=10)
            for name in controller_commands(settings, self.sent)
        }
        self.stopped = rospy.Publisher("estop_state", Bool, queue_size=1, latch=True)
        self.stopped.publish(self.motor.emergency)  # to who knows an earlier motor_control's
        callbacks = {
            "motor_output": (Twist, self.take_twist),
            "ackermann_cmd": (AckermannDriveStamped, self.take_ackermann),
            "estop": (Bool, self.take_stop),
        }
        self.subscribers = {
            topic: rospy.Subscriber(topic, kind, callback, queue_size=1, tcp_nodelay=True)
            for topic, (kind, callback) in callbacks.items()
        }

    def take_twist(self, msg):
        self.take("motor_output", DriveCommand(msg.linear.x, msg.angular.z))

    def take_ackermann(self, msg):
        self.take("ackermann_cmd", DriveCommand(msg.drive.speed, msg.drive.steering_angle))

    def take(self, topic, command):
        with self.lock:
            try:
                self.motor.take(command, rospy.get_time())
            except ValueError as error:
                rospy.logwarn_throttle(2, f"refused a command on {topic}: {error}")
                return
            self.source = topic
            self.send(self.motor.drive(rospy.get_time()))

    def take_stop(self, msg):
        with self.lock:
            if msg.data != self.motor.emergency:
                if msg.data:
                    rospy.logwarn("emergency stop. To release it, type: %s", release())
                else:
                    rospy.logwarn("emergency stop is over")
                self.stopped.publish(msg)
            self.motor.emergency = msg.data
            if msg.data:
                self.motor.forget()  # no earlier command is resumed afterwards
            self.send(self.motor.drive(rospy.get_time()))

    def change(self, settings):
        with self.lock:
            self.motor.settings = settings

    def send(self, drive):
        """Publish to all six controllers; call with the lock held."""
        self.sent, self.sent_wall = drive, time.monotonic()
        for name, value in controller_commands(self.motor.settings, drive).items():
            self.publishers[name].publish(value)

    def repeat(self):
        """Send what is due now; a stop is always due."""
        with self.lock:
            if self.source and self.subscribers[self.source].get_num_connections() == 0:
                self.motor.forget()  # the node that drove has ended, or was killed
            now = rospy.get_time()
            drive = self.motor.drive(now)
            if self.is_due(now) or (drive.speed == 0 and self.sent.speed != 0):
                self.send(drive)

    def is_due(self, now):
        rate = self.motor.settings.rate_hz
        if rate == 0:
            return False
        if now < self.next_time - 1 / rate:  # the clock was set back
            self.next_time = now
        if now >= self.next_time:
            self.next_time = max(self.next_time + 1 / rate, now)
            return True
        return time.monotonic() - self.sent_wall >= STILL_CLOCK

    def spin(self, ending):
        clock = rospy.rostime.get_rostime_cond()  # notified of each new simulated time
        while not ending.asked.is_set():
            with clock:
                clock.wait(min(WAKE, max(self.next_time - rospy.get_time(), 0.001)))
            self.repeat()

    def stop(self):
        """Send the final stop commands, after unsubscribing."""
        for subscriber in self.subscribers.values():
            subscriber.unregister()
        with self.lock:
            self.motor.forget()
            self.send(self.motor.drive(rospy.get_time()))
        time.sleep(FLUSH_TIME)


def main():
    start_node("motor_control", anonymous=True)
    ending = Ending()
    control = MotorControl(read_settings(MotorSettings, "car_control.yaml", "motor_control"))
    serve_settings(control.motor.settings, checked, control.change)
    control.spin(ending)
    control.stop()
    ending.done()


if __name__ == "__main__":
    main()
