"""dynamic_reconfigure for the gains of a PID, with control_toolbox's names and ranges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields

from dynamic_reconfigure.server import Server

from bullet_sim.control.pid import PidGains

RANGES = {"p": (-1e5, 1e5), "i": (-1e5, 1e5), "d": (-1e3, 1e3),
          "i_clamp_max": (0.0, 1e5), "i_clamp_min": (-1e5, 0.0), "antiwindup": (False, True)}
TELLS = {"p": "Proportional gain", "i": "Integral gain", "d": "Derivative gain",
         "i_clamp_max": "Greatest integral term", "i_clamp_min": "Least integral term",
         "antiwindup": "Clamp the integral of the error, not only its term"}
KINDS = {float: "double", bool: "bool"}


class _GainsType:
    """What dynamic_reconfigure's generator would have written for these gains."""

    def __init__(self, gains: PidGains):
        self.defaults = asdict(gains)
        self.min = {name: low for name, (low, _) in RANGES.items()}
        self.max = {name: high for name, (_, high) in RANGES.items()}
        self.level = dict.fromkeys(RANGES, 1)
        parameters = [
            {"name": name, "type": KINDS[type(value)], "default": value, "level": 1,
             "description": TELLS[name], "min": self.min[name], "max": self.max[name],
             "edit_method": ""}
            for name, value in self.defaults.items()
        ]
        self.config_description = {"name": "Default", "type": "", "state": True, "id": 0,
                                   "parent": 0, "parameters": parameters, "groups": []}


class GainsServer(Server):
    """`change(gains)` is called in a ROS thread, whenever somebody changes them."""

    def __init__(self, namespace: str, gains: PidGains, change: Callable[[PidGains], None]):
        def changed(config, _level):
            change(PidGains(**{field.name: config[field.name] for field in fields(PidGains)}))
            return config

        super().__init__(_GainsType(gains), changed, namespace)

    def _copy_from_parameter_server(self) -> None:
        """The gains were read already; here a whole number would turn into another type."""

    def close(self) -> None:
        """End topics and service."""
        self.set_service.shutdown("the controller was unloaded")
        self.descr_topic.unregister()
        self.update_topic.unregister()
