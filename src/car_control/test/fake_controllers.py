"""Stands where the car's six joint controllers would be, and keeps what they are told."""

import math
import threading
import time

import rospy
from std_msgs.msg import Float64

LIMIT = 60.0  # s, for everything that is waited for
WHEELS = tuple(
    f"{wheel}_wheel_velocity_controller"
    for wheel in ("left_rear", "right_rear", "left_front", "right_front")
)
HINGES = ("left_steering_hinge_position_controller", "right_steering_hinge_position_controller")


def wait_until(condition, what, limit=LIMIT):
    """Wait for condition() to become true, and return it; fail with what was waited for."""
    end = time.monotonic() + limit
    while time.monotonic() < end and not rospy.is_shutdown():
        answer = condition()
        if answer:
            return answer
        time.sleep(0.01)
    raise AssertionError(f"not within {limit} s: {what}")


class FakeControllers:
    """`told` holds (monotonic s, controller, command) in the order of arrival.

    Waits for motor_control where it `runs` already: rospy may never connect a subscriber and a
    publisher that come at the same moment.
    """

    def __init__(self, namespace="/racecar", runs=True):
        topics = {f"{namespace}/{name}/command" for name in WHEELS + HINGES}
        if runs:
            wait_until(lambda: topics <= {topic for topic, _ in rospy.get_published_topics()},
                       f"motor_control for {namespace}")
        self.told, self.now = [], {}
        self.lock = threading.Lock()
        self.subscribers = [
            rospy.Subscriber(f"{namespace}/{name}/command", Float64, self.keep, name)
            for name in WHEELS + HINGES
        ]

    def keep(self, msg, name):
        with self.lock:
            self.told.append((time.monotonic(), name, msg.data))
            self.now[name] = msg.data

    def wheels(self):
        """What the four wheels are told, rad/s, in the order of WHEELS."""
        return [self.now.get(name, math.nan) for name in WHEELS]

    def hinges(self):
        """What the two hinges are told, rad."""
        return [self.now.get(name, math.nan) for name in HINGES]

    def stand(self):
        return self.wheels() == [0.0] * 4

    def wait_for(self, wheels, hinges, what):
        """Until all six are told this, to a millionth."""
        def told():
            pairs = zip(self.wheels() + self.hinges(), [*wheels, *hinges])
            return all(math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9) for a, b in pairs)

        try:
            wait_until(told, what)
        except AssertionError as error:
            raise AssertionError(f"{error}; told: {self.wheels()} {self.hinges()}") from error

    def wait_for_speed(self, speed, what):
        """Until the four wheels together roll at this speed, m/s."""
        wait_until(lambda: math.isclose(sum(self.wheels()) * 0.05 / 4, speed, abs_tol=1e-6), what)
