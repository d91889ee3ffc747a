"""The context of a joint controller: its parameters, joints and topics, closed together."""

from collections.abc import Callable

import rospy

from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.hardware import RobotHardware
from bullet_sim.control.rate import Rate
from bullet_sim.errors import PluginError
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim_ros import names, params
from bullet_sim_ros.control.actions import LoopActionServer
from bullet_sim_ros.inputs import Input
from bullet_sim_ros.plugin_host import PluginContext


class ControllerContext:
    """One controller's view of robot and ROS. Made by the manager when the controller is loaded.

    Parameters: `self.parameters`, all below NS/<controller>, read once.
    Topics: relative names are below NS/<controller>; a callback `take(message)` runs in a ROS
    thread and returns a function for the loop, or None.
    """

    def __init__(
        self,
        context: PluginContext,
        name: str,
        manager_namespace: str,
        hardware: RobotHardware,
        robot: RobotFacts,
    ):
        self.name = name
        self.manager_namespace = manager_namespace  # absolute, /racecar
        self.namespace = names.join(manager_namespace, name)  # absolute, /racecar/<controller>
        self.parameters = params.of_controllers(self.namespace)
        self.joints: dict[str, JointHandle] = hardware.joints
        self.robot = robot  # the URDF's facts
        self.claims: dict[str, CommandHandle] = {}  # by joint name
        self.tasks: list[tuple[Rate, Callable[[], None]]] = []
        self.host, self.mailbox = context.host, context.host.mailbox
        self._hardware = hardware
        self._context = context

    def describe(self) -> str:
        """The controller's name in log lines."""
        return f"controller {self.namespace}"

    def world_time(self) -> float:
        """Simulated time, s."""
        return self._context.world.time

    # --- joints

    def joint(self, name: str) -> JointHandle:
        """The state of a joint; the error for an unknown name lists all joints."""
        return self._hardware.joint_handle(name)

    def claim(self, interface: str, joint: str) -> CommandHandle:
        """Claim a joint's command for this controller; PluginError if it has done so already."""
        handle = self._hardware.command_handle(interface, joint)
        if joint in self.claims:
            raise PluginError(f"joint {joint!r} is named twice")
        self.claims[joint] = handle
        return handle

    # --- ROS

    def every(self, rate_hz: float, action: Callable[[], None]) -> None:
        """Call `action` in the loop at a rate of simulated time until the controller is unloaded.

        SimulationError if the rate is negative or not finite.
        """
        self.tasks.append((Rate(rate_hz), action))

    def advertise(self, topic: str, kind: type, **options) -> rospy.Publisher:
        """A publisher that is open as long as the controller is loaded."""
        return self._context.advertise(names.join(self.namespace, topic), kind, **options)

    def subscribe(self, topic: str, kind: type, take: Callable, **options) -> rospy.Subscriber:
        """A subscriber; `take(message)` returns a function for the loop to call, or None."""
        return self._context.subscribe(names.join(self.namespace, topic), kind, take, **options)

    def serve(self, name: str, kind: type, handler: Callable) -> None:
        """A service; `handler(request)` runs in a ROS thread."""
        self._context.serve(names.join(self.namespace, name), kind, handler)

    def action(self, name: str, spec: type, on_goal: Callable,
               on_cancel: Callable) -> LoopActionServer:
        """An action server; `on_goal(goal_handle)` and `on_cancel(goal_handle)` run in the loop."""
        source = Input(names.join(self.namespace, name), None)
        server = LoopActionServer(source.name, spec,
                                  lambda handle: self.mailbox.post(
                                      lambda: on_goal(handle), source),
                                  lambda handle: self.mailbox.post(
                                      lambda: on_cancel(handle), source),
                                  auto_start=False)
        self.on_close(server.stop)
        self.every(server.STATUS_RATE, server.publish_status)
        server.start()
        return server

    def on_close(self, action: Callable[[], None]) -> None:
        """Call `action` when the controller is unloaded, before its topics are closed."""
        self._context.on_close(action)

    def close(self) -> None:
        """End all topics, services and actions."""
        self._context.close()
