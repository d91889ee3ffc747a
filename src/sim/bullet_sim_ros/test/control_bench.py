"""What tests of ros_control share: the manager's services, the log, and waiting for a condition."""

import rospy
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty

LIMIT = 60.0  # s, wall
STRICT, BEST_EFFORT = SwitchControllerRequest.STRICT, SwitchControllerRequest.BEST_EFFORT


def wait_until(condition, what):
    for _ in range(round(LIMIT / 0.02)):
        if condition():
            return
        rospy.rostime.wallsleep(0.02)
    raise AssertionError(f"not within {LIMIT} s: {what}")


def call(name, kind, *args, **fields):
    rospy.wait_for_service(name, LIMIT)
    return rospy.ServiceProxy(name, kind)(*args, **fields)


class Manager:
    """The bench's controller manager."""

    def load(self, *names):
        return [call("/bench/controller_manager/load_controller", LoadController, name).ok
                for name in names]

    def unload(self, *names):
        return [call("/bench/controller_manager/unload_controller", UnloadController, name).ok
                for name in names]

    def switch(self, start=(), stop=(), strictness=STRICT, timeout=0.0):
        return call("/bench/controller_manager/switch_controller", SwitchController,
                    start_controllers=start, stop_controllers=stop, strictness=strictness,
                    timeout=timeout).ok

    def list(self):
        return call("/bench/controller_manager/list_controllers", ListControllers).controller

    def states(self):
        return {controller.name: controller.state for controller in self.list()}

    def clear(self):
        call("/gazebo/unpause_physics", Empty)
        self.switch(stop=[name for name, state in self.states().items() if state == "running"])
        self.unload(*self.states())


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
