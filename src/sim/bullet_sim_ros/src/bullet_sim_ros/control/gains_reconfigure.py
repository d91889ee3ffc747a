"""dynamic_reconfigure for the gains of a PID, with control_toolbox's names and ranges."""

from collections.abc import Callable
from dataclasses import asdict

from bullet_sim.control.pid import PidGains
from bullet_sim_ros.reconfigure_server import Owner, Value, offer_values

RANGES = {"p": (-1e5, 1e5), "i": (-1e5, 1e5), "d": (-1e3, 1e3),
          "i_clamp_max": (0.0, 1e5), "i_clamp_min": (-1e5, 0.0), "antiwindup": (False, True)}
TELLS = {"p": "Proportional gain", "i": "Integral gain", "d": "Derivative gain",
         "i_clamp_max": "Greatest integral term", "i_clamp_min": "Least integral term",
         "antiwindup": "Clamp the integral of the error, not only its term"}


def offer_gains(owner: Owner, namespace: str, gains: PidGains,
                change: Callable[[PidGains], None]) -> None:
    """`change(gains)` is called in a ROS thread, at once and whenever somebody changes them."""
    values = {name: Value(now, *RANGES[name], TELLS[name]) for name, now in asdict(gains).items()}
    offer_values(owner, namespace, values, lambda new: change(PidGains(**new)))
