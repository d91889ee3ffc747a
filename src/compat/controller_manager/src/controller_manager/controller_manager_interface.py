"""Upstream's Python API, which prints its results; the causes of failures go to standard error.

Names are relative to this process's namespace. Each call waits for its service, without end.
"""

import sys

from controller_manager import diagnosis
from controller_manager.client import BEST_EFFORT, ManagerClient


def _say(line: str) -> None:
    sys.stdout.flush()  # the line belongs below what was printed before
    print(line, file=sys.stderr, flush=True)


def _client(service: str) -> ManagerClient:
    """To a manager that offers this service."""
    client = ManagerClient()
    client.wait(service, None, _say)
    return client


def list_controller_types() -> None:
    for kind in _client("list_controller_types").types():
        print(kind)


def list_controllers() -> None:
    controllers = _client("list_controllers").controllers()
    if not controllers:
        print("No controllers are loaded in mechanism control")
    for state in controllers:
        interfaces = dict.fromkeys(claim.hardware_interface for claim in state.claimed_resources)
        print(f"'{state.name}' - '{'+'.join(interfaces)}' ( {state.state} )")


def load_controller(name: str) -> bool:
    client = _client("load_controller")
    if client.load(name):
        print(f"Loaded '{name}'")
        return True
    print(f"Error when loading '{name}'")
    _say(f"{name}: {diagnosis.load_failure(client, name)}")
    return False


def unload_controller(name: str) -> bool:
    client = _client("unload_controller")
    if client.unload(name):
        print(f"Unloaded '{name}' successfully")
        return True
    print(f"Error when unloading '{name}'")
    _say(diagnosis.unload_failure(client, name))
    return False


def start_controller(name: str) -> bool:
    return start_stop_controllers(start_controllers=[name])


def start_controllers(names: list[str]) -> bool:
    return start_stop_controllers(start_controllers=names)


def stop_controller(name: str) -> bool:
    return start_stop_controllers(stop_controllers=[name])


def stop_controllers(names: list[str]) -> bool:
    return start_stop_controllers(stop_controllers=names)


def start_stop_controllers(start_controllers=(), stop_controllers=()) -> bool:
    """One strict switch: all of it or nothing."""
    start, stop = list(start_controllers), list(stop_controllers)
    client = _client("switch_controller")
    if not client.switch(start, stop):
        print(f"Error when starting {start} and stopping {stop}")
        _say(diagnosis.switch_failure(client.controllers(), start, stop))
        return False
    if start:
        print(f"Started {start} successfully")
    if stop:
        print(f"Stopped {stop} successfully")
    return True


def reload_libraries(force_kill: bool, restore: bool = False) -> bool:
    """With `restore` the controllers are loaded again afterwards, and those that ran started."""
    client = _client("reload_controller_libraries")
    print(f"Restore: {restore}")
    before = client.controllers() if restore else []
    done = client.reload(force_kill)
    print("Successfully reloaded libraries" if done
          else "Failed to reload libraries. Do you still have controllers loaded?")
    if restore:
        for state in before:
            client.load(state.name)
        client.switch(start=[s.name for s in before if s.state == "running"],
                      strictness=BEST_EFFORT)
        print("Controllers restored to original state")
    return done
