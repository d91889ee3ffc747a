"""The base class of sensor plugins, which add their parameters and their message."""

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
import rospy

from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host.context import PluginContext


class SensorPlugin(ABC):
    """Publishes what `measure` returns at a rate of simulated time, while somebody listens.

    Topic below `<robotNamespace>`, frame with tf_prefix, header, and noise by `<gaussianNoise>`.
    """

    def __init__(self, context: PluginContext, kind: type, topic: str, frame: str, *,
                 namespace: str | None = None,
                 tf_prefix: Callable[[str], str] = params.own_tf_prefix,
                 noise: str = "", queue_size: int = 1):
        """`topic`: empty for none. `frame`: as in the file; `tf_prefix(namespace)` is added to it.

        `namespace` replaces that of `<robotNamespace>`; `noise` is the name of the sensor's random
        numbers, and without one `<gaussianNoise>` is not read. PluginError if tags are wrong.
        """
        p = context.parameters
        self.context, self.world = context, context.world
        self.namespace = p.namespace(missing="/", empty="/") if namespace is None else namespace
        self.frame = names.frame(tf_prefix(self.namespace), frame)
        self.noise = p.deviation("gaussianNoise") if noise else 0.0  # standard deviation
        self._noise_name = noise
        self._publishers: list[rospy.Publisher] = []
        self._main = self.advertise(kind, topic, queue_size)

    @abstractmethod
    def measure(self) -> object:
        """The message, without its header."""

    def advertise(self, kind: type, topic: str, queue_size: int = 1) -> rospy.Publisher | None:
        """A topic of the sensor; None if its name is empty."""
        if not topic:
            return None
        self._publishers.append(self.context.advertise(
            names.join(self.namespace, topic), kind, queue_size=queue_size))
        return self._publishers[-1]

    def publish_at(self, rate_hz: float, whole_steps: bool = True) -> None:
        """Measure at a rate, 0: at every step; for `whole_steps` see `TickRate`."""
        if self._publishers:
            self.context.every(rate_hz, self._publish, self.wanted, whole_steps)

    def publish_readings(self, rate_hz: float = 0.0) -> None:
        """Measure at the `<sensor>`'s own rate, thinned to `rate_hz`; 0: at each reading."""
        if self._publishers:
            self.context.every_reading(rate_hz, self._publish, self.wanted)

    def wanted(self) -> bool:
        """Whether anybody listens."""
        return any(publisher.get_num_connections() for publisher in self._publishers)

    def random(self) -> np.random.Generator:
        """The generator of the sensor's noise, the same at a tick in every run with one seed."""
        return self.world.random(self._noise_name)

    def disturbed(self, values: np.ndarray) -> np.ndarray:
        """Values with the noise of `<gaussianNoise>`."""
        if not self.noise:
            return values
        return values + self.random().normal(0.0, self.noise, np.shape(values))

    def stamped(self, message):
        """The message with its header: now, in the sensor's frame."""
        return convert.stamped(message, self.world.time, self.frame)

    def _publish(self) -> None:
        message = self.stamped(self.measure())
        if self._main is not None:
            self.context.host.lockstep.expect(self.context, self._main.resolved_name)
            self._main.publish(message)


def no_tf_prefix(_namespace: str) -> str:
    """For plugins whose frames have no tf_prefix."""
    return ""
