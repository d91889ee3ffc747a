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
from rclpy.signals import SignalHandlerOptions


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


class Ending:
    """A signal only sets `asked`; the main thread sends its last messages, then calls `done`."""

    def __init__(self):
        self.asked = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda *_: self.asked.set())

    def done(self):
        rclpy.try_shutdown()
