"""What the tests of controllers share: the manager's services, truth, and waiting."""

import math

import rospy
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from gazebo_msgs.srv import GetModelState

LIMIT = 60.0  # s, wall


def wait_until(condition, what):
    for _ in range(round(LIMIT / 0.02)):
        if condition():
            return
        rospy.rostime.wallsleep(0.02)
    raise AssertionError(f"not within {LIMIT} s: {what}")


def pass_time(seconds):
    """Simulated seconds."""
    until = rospy.get_time() + seconds
    wait_until(lambda: rospy.get_time() >= until, f"{seconds} s of simulated time")


class Manager:
    """The controller manager of one robot."""

    def __init__(self, namespace):
        self._prefix = f"/{namespace}/controller_manager/"

    def _call(self, name, kind, *arguments, **fields):
        rospy.wait_for_service(self._prefix + name, LIMIT)
        return rospy.ServiceProxy(self._prefix + name, kind)(*arguments, **fields)

    def load(self, name):
        return self._call("load_controller", LoadController, name).ok

    def unload(self, name):
        return self._call("unload_controller", UnloadController, name).ok

    def switch(self, start=(), stop=()):
        return self._call("switch_controller", SwitchController, start_controllers=start,
                          stop_controllers=stop, strictness=SwitchControllerRequest.STRICT).ok

    def state(self, name):
        controllers = self._call("list_controllers", ListControllers).controller
        return {made.name: made.state for made in controllers}.get(name)

    def reload(self, name):
        """Stop, unload, load and start."""
        if not self.switch(stop=[name]) or not self.unload(name):
            raise AssertionError(f"{name} was not unloaded")
        self.run(name)

    def run(self, *names):
        """Load and start; running already is fine, too."""
        for name in names:
            if self.state(name) is None and not self.load(name):
                raise AssertionError(f"{name} was not loaded")
            if self.state(name) != "running" and not self.switch([name]):
                raise AssertionError(f"{name} was not started")


def truth(model):
    """(x, y, yaw, forward, leftward, yaw rate) of a model in the world."""
    state = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)(model, "")
    p, v = state.pose.position, state.twist.linear
    yaw = yaw_of(state.pose.orientation)
    return (p.x, p.y, yaw, v.x * math.cos(yaw) + v.y * math.sin(yaw),
            v.y * math.cos(yaw) - v.x * math.sin(yaw), state.twist.angular.z)


def yaw_of(q):
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))


def turned(first, last):
    """The way from one angle to another, in (-pi, pi]."""
    return math.remainder(last - first, 2 * math.pi)
