"""Plans a switch of controllers, or says why it is refused, by controller_manager's rules."""

import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from bullet_sim.errors import SimulationError
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.registry import Controller

INITIALIZED, RUNNING, STOPPED, ABORTED = "initialized", "running", "stopped", "aborted"
WAITING = "waiting"  # to be started by the next update


class ManagerError(SimulationError):
    """A request that is refused, in the words of controller_manager.cpp."""


class Gone(ManagerError):
    """The simulation or the model ended during a wait."""


@dataclass
class Loaded:
    """A controller that is loaded."""

    name: str
    type: str
    controller: Controller
    context: ControllerContext
    state: str = INITIALIZED

    @property
    def runs(self) -> bool:
        """Whether it is updated."""
        return self.state == RUNNING


@dataclass
class Switch:
    """What is to be started and stopped at the next update."""

    start: list[Loaded]
    stop: list[Loaded]
    done: threading.Event = field(default_factory=threading.Event)


def plan(loaded: Mapping[str, Loaded], start: Sequence[str], stop: Sequence[str],
         strict: bool) -> Switch:
    """Plan a switch. ManagerError if it contradicts itself or two controllers share a joint; if
    `strict`, also if a controller is unknown or in the requested state already.
    """
    stops = _known(loaded, stop, "stop", strict)
    starts = _known(loaded, start, "start", strict)
    for one in starts:
        if one in stops:
            raise ManagerError(f"Could no start or stop controller '{one.name}' because of "
                               "conflicting switching command")
    for one in stops:
        if strict and not one.runs:
            raise ManagerError(f"Could not stop controller '{one.name}' since it is not running")
    for one in starts:
        if strict and one.runs:
            raise ManagerError(f"Controller '{one.name}' is already running")
    switch = Switch([one for one in starts if not one.runs], [one for one in stops if one.runs])
    stay = [one for one in loaded.values() if one.runs and one not in switch.stop]
    _check_for_conflict([*stay, *switch.start])
    return switch


def absent(what: str, name: str, loaded: Iterable[str]) -> ManagerError:
    """The error for a request to do `what` to a controller that is not `loaded`."""
    return ManagerError(f"Could not {what} controller with name '{name}' because no controller "
                        f"with this name exists; there are: {', '.join(loaded) or 'none'}")


def _known(loaded: Mapping[str, Loaded], names: Iterable[str], what: str,
           strict: bool) -> list[Loaded]:
    found = []
    for name in dict.fromkeys(names):
        if name in loaded:
            found.append(loaded[name])
        elif strict:
            raise absent(what, name, loaded)
    return found


def _check_for_conflict(together: Iterable[Loaded]) -> None:
    """ManagerError if two controllers command a joint, through whatever interface."""
    holder: dict[str, Loaded] = {}
    for loaded in together:
        for joint in loaded.context.claims:
            other = holder.setdefault(joint, loaded)
            if other is not loaded:
                raise ManagerError(
                    "Could not switch controllers, due to resource conflict: joint "
                    f"'{joint}' is claimed by '{other.name}' ({other.state}) and by "
                    f"'{loaded.name}' ({loaded.state})")
