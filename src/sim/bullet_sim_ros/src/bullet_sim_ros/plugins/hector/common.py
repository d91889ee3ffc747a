"""What hector_gazebo's sensor plugins share: their link, rate, error tags and reconfiguration."""

from __future__ import annotations

import math
from dataclasses import replace

from bullet_sim.errors import PluginError
from bullet_sim.link import Link
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim.sensors.error_model import ErrorModel, ErrorParameters
from bullet_sim_ros import names
from bullet_sim_ros.plugin_host import PluginContext, SensorPlugin, no_tf_prefix
from bullet_sim_ros.reconfigure_server import Value, offer_changes

TAGS = {"offset": "offset", "drift": "drift", "drift_frequency": "driftFrequency",
        "gaussian_noise": "gaussianNoise", "scale_error": "scaleError"}
RANGES = {"gaussian_noise": (0.0, 10.0, "Standard deviation of the white noise"),
          "offset": (0.0, 10.0, "Constant offset"),
          "drift": (0.0, 10.0, "Standard deviation of the drift"),
          "drift_frequency": (0.0, 1.0, "Reciprocal of the drift's time constant, Hz"),
          "scale_error": (0.0, 2.0, "Factor on the true value")}


def find_link(context: PluginContext) -> Link:
    """The link that `bodyName` names, else the model's first; PluginError if there is none."""
    name = context.parameters.text("bodyName")
    links = context.model.description.links
    if not name and not links:
        raise PluginError("the model has no link")
    return context.model.link(name or links[0].name)


class HectorSensor(SensorPlugin):
    """The frame is `<frameId>`, without tf_prefix; errors drift with and without subscribers."""

    def __init__(self, context: PluginContext, kind: type, topic: str, frame: str,
                 queue_size: int = 10):
        """`topic` and `frame` are the defaults where there are no tags."""
        p = context.parameters
        self._errors: list[ErrorModel] = []
        self._measured: float | None = None  # s, time of the last measurement
        context.on_reset(self._restart)
        self.topic = p.topic(topic)
        super().__init__(context, kind, self.topic, p.text("frameId", frame),
                         tf_prefix=no_tf_prefix, queue_size=queue_size)

    def add_error(self, name: str, size: int, *prefixes: str) -> ErrorModel:
        """Add an error model with `size` components, from the tags with these prefixes.

        Where several tags are set, the last prefix counts. PluginError if a tag is not a number.
        """
        context = self.context
        error = ErrorModel(
            self.world, f"{context.model.name}::{context.description.name} {name}",
            read_errors(context.parameters, size, prefixes or ("",)))
        context.on_reset(error.restart)
        self._errors.append(error)
        return error

    def offer(self, error: ErrorModel, name: str = "") -> None:
        """Let dynamic_reconfigure change the error model, below the topic if there is one."""
        if self.topic:
            offer_errors(self.context, error,
                         names.join(names.join(self.namespace, self.topic), name))

    def elapsed(self) -> float:
        """Since the last call, s; 0 at the first."""
        now, before = self.world.time, self._measured
        self._measured = now
        return 0.0 if before is None else max(0.0, now - before)

    def _restart(self) -> None:
        self._measured = None

    def begin(self, default_hz: float) -> None:
        """Measure at `updateRate`, Hz; `updatePeriod`, s, takes precedence; 0: every step."""
        p = self.context.parameters
        rate_hz = p.number("updateRate", default_hz)
        if p.text("updatePeriod"):
            period = p.number("updatePeriod", 0.0)
            rate_hz = 1.0 / period if period > 0 else 0.0
        self.publish_at(rate_hz, whole_steps=False)

    def wanted(self) -> bool:
        """A drift goes on without subscribers, too."""
        return any(error.drifts for error in self._errors) or super().wanted()


def offer_errors(context: PluginContext, error: ErrorModel, namespace: str) -> None:
    """Let dynamic_reconfigure change an error model; each value is set for all components.

    sensor_model.h, dynamicReconfigureCallback.
    """
    means = {name: math.fsum(values) / len(values)
             for name, values in vars(error.parameters).items()}

    def change(values: dict[str, float]) -> None:
        size = len(error.parameters.offset)
        error.parameters = ErrorParameters(**{name: (values[name],) * size for name in TAGS})

    offer_changes(context, namespace,
                  {name: Value(means[name], *RANGES[name]) for name in RANGES}, change)


def with_noise(errors: ErrorParameters, noise: float) -> ErrorParameters:
    """A copy with this standard deviation of white noise on each component."""
    return replace(errors, gaussian_noise=(noise,) * len(errors.offset))


def read_errors(p: PluginParameters, size: int, prefixes: tuple[str, ...]) -> ErrorParameters:
    """Read `accelOffset` and so on for the prefix `accel`, `offset` and so on for an empty one.

    PluginError if a tag has no number, or a negative one where none can be.
    """
    values = vars(ErrorParameters.none(size))
    for prefix in prefixes:
        for name, tag in TAGS.items():
            tag = prefix + tag[0].upper() + tag[1:] if prefix else tag
            values = {**values, name: _components(p, tag, values[name])}
    return ErrorParameters(**values)


def _components(p: PluginParameters, tag: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """As many numbers as there are components, or one for all of them."""
    values = p.numbers(tag, default, one_for_all=True)
    if not tag.lower().endswith("offset") and min(values) < 0:
        raise PluginError(f"<{tag}> is {p.text(tag)!r}, and that cannot be negative")
    return values
