"""A plugin's scope: the world, a model, a sensor or a visual."""

from typing import TypeVar

from bullet_sim.description import PluginDescription, SensorDescription, Visual
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.world import World
from bullet_sim_ros.errors import PluginError

Part = TypeVar("Part")  # a model, sensor, visual or link


class PluginScope:
    """A plugin's element and those around it; PluginError if a requested one does not exist."""

    def __init__(self, world: World, model: Model | None, description: PluginDescription,
                 sensor: SensorDescription | None = None, link: Link | None = None,
                 visual: Visual | None = None):
        self.world = world
        self.description = description
        self._model = model
        self._sensor = sensor
        self._link = link
        self._visual = visual

    @property
    def model(self) -> Model:
        """The model that the plugin is in; PluginError if it is in the world."""
        return _inside(self._model, "a <model>, not in the world")

    @property
    def kind(self) -> str:
        """What the plugin is in: `visual`, `sensor`, `model` or `world`."""
        if self._visual is not None:
            return "visual"
        if self._sensor is not None:
            return "sensor"
        return "world" if self._model is None else "model"

    @property
    def visual(self) -> Visual:
        """The visual that the plugin is in; PluginError if it is in none."""
        return _inside(self._visual, "a <visual>")

    @property
    def sensor(self) -> SensorDescription:
        """The sensor that the plugin is in; PluginError if it is in none."""
        return _inside(self._sensor, "a <sensor>, not in the model")

    @property
    def link(self) -> Link:
        """The link that the sensor or visual is on; PluginError if the plugin is in none."""
        return _inside(self._link, "a <sensor>, not in the model")

    @property
    def sensor_name(self) -> str:
        """`model::link::sensor`."""
        return f"{self.link.scoped_name}::{self.sensor.name}"

    def describe(self) -> str:
        """Model, sensor or visual, and plugin, for log lines."""
        sensor = f" sensor {self._sensor.name}:" if self._sensor else ""
        if self._visual is not None:
            sensor = f" visual {self._visual.name}:"
        name = self.description.name or "(no name)"
        place = f"model {self._model.name}:" if self._model else \
            f"world {self.world.description.name}:"
        return f"{place}{sensor} plugin {name} ({self.description.filename})"


def _inside(part: Part | None, what: str) -> Part:
    if part is None:
        raise PluginError(f"it belongs inside {what}")
    return part
