"""What contracts over ROS share: waiting, the log, the manager of ros_control, and truth."""

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
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty

LIMIT = 60.0  # s, wall
STRICT, BEST_EFFORT = SwitchControllerRequest.STRICT, SwitchControllerRequest.BEST_EFFORT


def wait_until(condition, what):
    """Poll on the wall clock: simulated time may stand still."""
    for _ in range(round(LIMIT / 0.02)):
        if condition():
            return
        rospy.rostime.wallsleep(0.02)
    raise AssertionError(f"not within {LIMIT} s: {what}")


def pass_time(seconds):
    """Simulated seconds."""
    until = rospy.get_time() + seconds
    wait_until(lambda: rospy.get_time() >= until, f"{seconds} s of simulated time")


def call(name, kind, *args, **fields):
    rospy.wait_for_service(name, LIMIT)
    return rospy.ServiceProxy(name, kind)(*args, **fields)


class Manager:
    """The controller manager of one robot."""

    def __init__(self, namespace):
        self._prefix = f"/{namespace}/controller_manager/"

    def load(self, name):
        return call(self._prefix + "load_controller", LoadController, name).ok

    def unload(self, name):
        return call(self._prefix + "unload_controller", UnloadController, name).ok

    def switch(self, start=(), stop=(), strictness=STRICT, timeout=0.0):
        return call(self._prefix + "switch_controller", SwitchController, start_controllers=start,
                    stop_controllers=stop, strictness=strictness, timeout=timeout).ok

    def list(self):
        return call(self._prefix + "list_controllers", ListControllers).controller

    def states(self):
        return {controller.name: controller.state for controller in self.list()}

    def reload(self, name):
        """Stop, unload, load and start."""
        if not self.switch(stop=[name]) or not self.unload(name):
            raise AssertionError(f"{name} was not unloaded")
        self.run(name)

    def run(self, *names):
        """Load and start; running already is fine, too."""
        for name in names:
            state = self.states().get(name)
            if state is None and not self.load(name):
                raise AssertionError(f"{name} was not loaded")
            if state != "running" and not self.switch([name]):
                raise AssertionError(f"{name} was not started")

    def clear(self):
        call("/gazebo/unpause_physics", Empty)
        states = self.states()
        self.switch(stop=[name for name, state in states.items() if state == "running"])
        for name in states:
            self.unload(name)


class Rosout:
    """The lines that the simulator logs."""

    def __init__(self):
        self.lines = []
        self._subscriber = rospy.Subscriber("/rosout", Log, self._take)
        wait_until(self._subscriber.get_num_connections, "rosout")

    def _take(self, msg):
        if msg.name == "/gazebo":
            self.lines.append(msg.msg)

    def wait_for(self, *parts):
        wait_until(lambda: any(all(part in line for part in parts) for line in self.lines),
                   f"a line with {parts} among {self.lines}")


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
