"""/gazebo/performance_metrics: the real-time factor, and how often each sensor is updated."""

import time

import rospy
from gazebo_msgs.msg import PerformanceMetrics, SensorPerformanceMetric

from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.simulation import Simulation

PERIOD = 0.2  # s, wall, between messages
WINDOW = 1.0  # s, wall, over which rates are taken
NO_FRAMES = -1.0  # gazebo_ros_api_plugin.cpp, onPerformanceMetrics, of a sensor without fps


class MetricsTopic:
    """Published five times a second of wall time, while subscribed to and time runs."""

    def __init__(self, simulation: Simulation):
        self._simulation = simulation
        self._publisher = rospy.Publisher(names.PERFORMANCE_METRICS, PerformanceMetrics,
                                          queue_size=10)
        self._due = 0.0  # s, wall
        self._rates: dict[PluginContext, _Rates] = {}
        simulation.scheduler.add(0.0, self._publish, self._wanted)

    def _wanted(self) -> bool:
        return time.monotonic() >= self._due and self._publisher.get_num_connections() > 0

    def _publish(self) -> None:
        self._due = time.monotonic() + PERIOD
        simulation = self._simulation
        msg = PerformanceMetrics(real_time_factor=simulation.real_time_factor.measured)
        convert.stamped(msg, simulation.world.time)
        contexts = simulation.sensors()
        self._rates = {context: self._rates.get(context) or _Rates() for context in contexts}
        for context, rates in self._rates.items():
            rates.update(time.monotonic(), simulation.world.time, context.updates)
            fps = rates.real_hz if context.sensor.cameras else NO_FRAMES
            msg.sensors.append(SensorPerformanceMetric(
                context.sensor.name, rates.simulated_hz, rates.real_hz, fps))
        self._publisher.publish(msg)


class _Rates:
    """Updates per simulated and per wall second, over the last window."""

    def __init__(self):
        self.simulated_hz = self.real_hz = 0.0
        self._start: tuple[float, float, int] | None = None

    def update(self, wall: float, simulated: float, count: int) -> None:
        """Times in s; a clock set back begins a new window."""
        if self._start is None or simulated < self._start[1]:
            self._start = (wall, simulated, count)
        elapsed, passed = wall - self._start[0], simulated - self._start[1]
        if elapsed >= WINDOW and passed > 0:
            done = count - self._start[2]
            self.simulated_hz, self.real_hz = done / passed, done / elapsed
            self._start = (wall, simulated, count)
