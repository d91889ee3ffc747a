"""The controller manager: loads, unloads, switches and lists controllers."""

import logging
import threading
import time as wall
from collections.abc import Callable, Sequence

from bullet_sim.control.rate import Rate
from bullet_sim_ros.control import registry, switching
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.switching import Gone, Loaded, ManagerError, Switch
from bullet_sim_ros.errors import format_error

log = logging.getLogger("bullet_sim.control")

LOOK = 0.1  # s, wall clock: how often to check whether the simulation has ended


class ControllerManager:
    """`update` and `close` belong to the loop's thread, everything else to ROS's threads."""

    def __init__(self, open_context: Callable[[str], ControllerContext],
                 stopped: Callable[[], bool] = lambda: False):
        self._open_context = open_context
        self._stopped = stopped
        self._one_at_a_time = threading.Lock()  # for requests
        self._handover = threading.Lock()  # for passing a switch to the loop
        self._switch: Switch | None = None
        self._closed = False
        self._loaded: dict[str, Loaded] = {}
        self._running: list[Loaded] = []
        self._tasks: list[tuple[Rate, Callable[[], None]]] = []

    # --- the loop

    def update(self, time: float, period: float, restart: bool = False) -> None:
        """Do a requested switch, restart running controllers if `restart`, then update them."""
        if self._switch is not None:
            self._carry_out(time)
        if restart:
            for loaded in self._running:
                self._stop(loaded, time)
                self._start(loaded, time)
            self._note_running()
        for loaded in self._running:
            try:
                loaded.controller.update(time, period)
            except Exception as error:  # one controller's failure must not affect the others
                self._abort(loaded, time, error)
        for rate, action in self._tasks:
            if rate.due(time):
                action()

    def close(self) -> None:
        """End all controllers and their topics; a thread that waits for a switch gets Gone."""
        self._closed = True
        for loaded in self._loaded.values():
            loaded.context.close()
        self._loaded, self._running, self._tasks = {}, [], []

    def _carry_out(self, time: float) -> None:
        with self._handover:
            switch, self._switch = self._switch, None
        if switch is None:  # withdrawn meanwhile
            return
        for loaded in switch.stop:
            self._stop(loaded, time)
        for loaded in switch.start:
            self._start(loaded, time)
        self._note_running()
        switch.done.set()

    def _start(self, loaded: Loaded, time: float) -> None:
        loaded.state = switching.RUNNING
        try:
            loaded.controller.start(time)
        except Exception as error:
            self._abort(loaded, time, error)

    def _stop(self, loaded: Loaded, time: float) -> None:
        loaded.state = switching.STOPPED
        try:
            loaded.controller.stop(time)
        except Exception as error:
            self._abort(loaded, time, error)
        for handle in loaded.context.claims.values():
            handle.rest()

    def _abort(self, loaded: Loaded, time: float, error: Exception) -> None:
        log.error("Controller '%s' failed and is stopped: %s", loaded.name, format_error(error))
        loaded.state = switching.ABORTED
        for handle in loaded.context.claims.values():
            handle.rest()
        self._note_running()

    def _note_running(self) -> None:
        self._running = [loaded for loaded in self._loaded.values() if loaded.runs]

    # --- requests

    def list(self) -> list[Loaded]:
        """All controllers, in the order in which they were loaded."""
        return list(self._loaded.values())

    def state_of(self, loaded: Loaded) -> str:
        """As named in ControllerState.msg; `waiting` until the next update starts it."""
        switch = self._switch
        return switching.WAITING if switch is not None and loaded in switch.start else loaded.state

    def load(self, name: str) -> None:
        """Create a controller from the parameters below its name; ManagerError if that fails."""
        with self._one_at_a_time:
            if name in self._loaded:
                raise ManagerError(f"A controller named '{name}' was already loaded inside the "
                                   "controller manager")
            try:
                context = self._open_context(name)
            except Exception as error:  # an illegal name, or no master
                raise ManagerError(
                    f"Could not load controller '{name}': {format_error(error)}"
                ) from error
            try:
                loaded = _make_controller(name, context)
            except Exception:
                context.close()
                raise
            if self._closed:
                context.close()
                raise ManagerError(f"The model of controller '{name}' was deleted")
            self._loaded = {**self._loaded, name: loaded}
            self._collect_tasks()

    def unload(self, name: str) -> None:
        """Unload a controller; ManagerError if it runs or does not exist."""
        with self._one_at_a_time:
            loaded = self._loaded.get(name)
            if loaded is None:
                raise switching.absent("unload", name, self._loaded)
            if loaded.runs:
                raise ManagerError(f"Could not unload controller with name '{name}' because it is "
                                   "still running")
            self._loaded = {key: other for key, other in self._loaded.items() if key != name}
            self._collect_tasks()
            loaded.context.close()

    def switch(self, start: Sequence[str], stop: Sequence[str], strict: bool,
               timeout: float = 0.0) -> None:
        """Start and stop at the next update; waits for it up to `timeout` (s, wall; 0: for ever).

        ManagerError if it is refused or takes longer, Gone if model or simulation end meanwhile.
        """
        with self._one_at_a_time:
            switch = switching.plan(self._loaded, start, stop, strict)
            if not switch.start and not switch.stop:
                return
            with self._handover:
                self._switch = switch
            self._wait(switch, timeout)

    def reload(self, force: bool) -> None:
        """Stop and unload all controllers (reloadControllerLibrariesSrv).

        ManagerError if any are loaded and `force` is not set.
        """
        names = list(self._loaded)
        if names and not force:
            raise ManagerError("Controller manager: Cannot reload controller libraries because "
                               f"there are still {len(names)} controllers running")
        self.switch([], names, strict=False)
        for name in names:
            self.unload(name)

    def _wait(self, switch: Switch, timeout: float) -> None:
        until = wall.monotonic() + timeout if timeout > 0 else float("inf")
        while not switch.done.wait(min(LOOK, max(0.0, until - wall.monotonic()))):
            late = wall.monotonic() >= until
            if not (late or self._closed or self._stopped()):
                continue
            with self._handover:
                if self._switch is not switch:  # the loop is doing it now
                    continue
                self._switch = None
            if late:
                raise ManagerError(f"Could not switch controllers within {timeout:g} s: is physics "
                                   "paused?")
            raise Gone("Could not switch controllers: the simulation or the model is gone")

    def _collect_tasks(self) -> None:
        self._tasks = [task for loaded in self._loaded.values() for task in loaded.context.tasks]


def _make_controller(name: str, context: ControllerContext) -> Loaded:
    """Create a controller of the parameter `type`; ManagerError if that fails."""
    kind = context.parameters.value("type", None)
    if kind is None:
        raise ManagerError(
            f"Could not load controller '{name}' because the type was not specified. Did you "
            "load the controller configuration on the parameter server (namespace: "
            f"'{context.namespace}')? Parameter {context.parameters.where('type')} is not set")
    made = registry.find(str(kind))
    if made is None:
        raise ManagerError(
            f"Could not load controller '{name}' because controller type '{kind}' does not "
            f"exist{registry.hint(str(kind)) or '.'} Use 'rosservice call "
            "controller_manager/list_controller_types' to get the available types")
    try:
        return Loaded(name, str(kind), made(context), context)
    except Exception as error:
        raise ManagerError(
            f"Initializing controller '{name}' failed: {format_error(error)}"
        ) from error
