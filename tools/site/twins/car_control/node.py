"""Starts and ends the package's nodes, and reads their settings.  启动和结束节点，读取参数。

A settings' dataclass becomes parameters of the node, with types and bounds; a YAML file with them
is given by --ros-args --params-file. There is no dynamic_reconfigure: `ros2 param set` does it.
"""

import signal
import threading
from dataclasses import fields, replace
from pathlib import Path

import rclpy
import yaml
from ament_index_python.packages import get_package_share_directory
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.executors import ExternalShutdownException
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions
from std_msgs.msg import Bool


def start_node(name):
    """A node whose callbacks run in a thread beside the main one.  回调在另一个线程中执行。"""
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(name)
    threading.Thread(target=_spin, args=[node], daemon=True).start()
    return node


def _spin(node):
    try:
        rclpy.spin(node)
    except ExternalShutdownException:
        pass  # Ending.done()


def read_settings(node, kind, file, section=None, package="car_control"):
    """An instance of the dataclass `kind`; a file of the package has the defaults."""
    path = Path(get_package_share_directory(package), "config", file)
    defaults = yaml.safe_load(path.read_text("utf-8"))
    defaults, values = defaults[section] if section else defaults, {}
    for entry in fields(kind):
        described = ParameterDescriptor(description=entry.metadata.get("meaning", ""))
        if "low" in entry.metadata and isinstance(defaults[entry.name], float):
            described.floating_point_range = [FloatingPointRange(
                from_value=entry.metadata["low"], to_value=entry.metadata["high"], step=0.0)]
        values[entry.name] = node.declare_parameter(
            entry.name, defaults[entry.name], described).value
    return kind(**values)


def serve_settings(node, settings, apply):
    """`apply` gets the settings after each `ros2 param set`.  参数改变后调用 apply。"""
    current = settings

    def change(parameters):
        nonlocal current
        known = {each.name: each.value for each in parameters if hasattr(current, each.name)}
        try:
            current = replace(current, **known)
        except ValueError as error:
            return SetParametersResult(successful=False, reason=str(error))
        apply(current)
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(change)


class StopNotice:
    """Says when motor_control's emergency stop is on, and how to release it.  急停提示"""

    def __init__(self, node):
        self.node, self.is_on = node, False
        kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        node.create_subscription(Bool, "estop_state", self.take, kept)

    def take(self, state):
        if state.data and not self.is_on:
            self.node.get_logger().warning("the emergency stop is on, and the car stands. "
                                           f"To release it, type: {release(self.node)}")
        elif self.is_on and not state.data:
            self.node.get_logger().info("the emergency stop is over")
        self.is_on = state.data


def release(node):
    """The command that releases the emergency stop.  解除急停的命令"""
    topic = node.resolve_topic_name("estop")
    return f"ros2 topic pub --once {topic} std_msgs/msg/Bool '{{data: false}}'"


class Ending:
    """A signal only sets `asked`; the main thread sends its last messages, then calls `done`."""

    def __init__(self):
        self.asked = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda *_: self.asked.set())

    def done(self):
        rclpy.try_shutdown()
