"""Finds the cause of a manager's `ok: false`, from what it lists and the parameters there are."""

import difflib
from collections import defaultdict
from collections.abc import Collection, Sequence

import rospy
from controller_manager_msgs.msg import ControllerState

from controller_manager.client import ManagerClient

ALIKE = 0.75  # of difflib
SEE_LOG = "the manager's own error line, in the simulator's terminal, says why"


def _join(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


def _configured(namespace: str, parameters: Collection[str]) -> list[str]:
    """The names one level below a namespace that have a type."""
    start = _join(namespace, "")
    below = [name.removeprefix(start) for name in parameters if name.startswith(start)]
    return sorted(name.removesuffix("/type") for name in below
                  if name.endswith("/type") and name.count("/") == 1)


def _beside(name: str, namespace: str, parameters: Collection[str]) -> list[str]:
    """The controllers in the part of the namespace that the name says, else in the namespace."""
    folder = name.strip("/").rpartition("/")[0]
    inside = _configured(_join(namespace, folder), parameters) if folder else []
    return [_join(folder, other) for other in inside] or _configured(namespace, parameters)


def _below(namespace: str, name: str, parameters: Collection[str]) -> str:
    """The controller's name without the part that the namespace says already; "" if none is."""
    parts = name.strip("/").split("/")
    ends = ["/".join(parts[first:]) for first in range(0 if name.startswith("/") else 1,
                                                       len(parts))]
    return next((end for end in ends if f"{_join(namespace, end)}/type" in parameters), "")


def _listing(names: Collection[str]) -> str:
    return ", ".join(names) or "none"


def not_configured(name: str, namespace: str, parameters: Collection[str]) -> str:
    """Why a controller has no type; `parameters` are the names of all that are set."""
    if short := _below(namespace, name, parameters):
        return (f"{name} is looked for in {namespace}, as {_join(namespace, name.lstrip('/'))}: "
                f"write {short}")
    wanted = f"{_join(namespace, name)}/type"
    inner = _configured(_join(namespace, name), parameters)
    if inner:
        return (f"{name} is a namespace with the controllers {_listing(inner)}: "
                f"spawn these with --namespace={_join(namespace, name)}")
    reason = f"parameter {wanted} is not set"
    load = f'<rosparam command="load" file="..." ns="{namespace}"/>'
    if elsewhere := sorted(p for p in parameters if p.endswith(f"/{name}/type")):
        return f"{reason}, but {elsewhere[0]} is: load the YAML file into {namespace}, {load}"
    others = _beside(name, namespace, parameters)
    if not others:
        return f"{reason}, nor is any controller's in {namespace}: load the YAML file, {load}"
    close = difflib.get_close_matches(name, others, 1, ALIKE)
    return f"{reason}; in {namespace} there are: {_listing(others)}" + (
        f"; is {close[0]} meant?" if close else "")


def unknown_type(kind: str, types: Sequence[str]) -> str:
    """The line for a type that the manager does not know."""
    close = difflib.get_close_matches(kind, types, 1, ALIKE)
    return f"there is no controller type {kind}" + (
        f"; is {close[0]} meant?" if close
        else ": `rosrun controller_manager controller_manager list-types` shows those there are")


def load_failure(client: ManagerClient, name: str) -> str:
    """Why this controller could not be loaded."""
    state = {s.name: s.state for s in client.controllers()}.get(name)
    if state:
        return (f"it is loaded already ({state}); to unload it: "
                f"rosrun controller_manager controller_manager kill {name}")
    parameters = rospy.get_param_names()
    wanted = f"{_join(client.namespace, name)}/type"
    if wanted not in parameters:
        return not_configured(name, client.namespace, parameters)
    kind, types = str(rospy.get_param(wanted)), client.types()
    return SEE_LOG if kind in types else unknown_type(kind, types)


def unload_failure(client: ManagerClient, name: str) -> str:
    """Why this controller could not be unloaded."""
    states = {s.name: s.state for s in client.controllers()}
    if name not in states:
        return f"{name} is not loaded; loaded: {_listing(states)}"
    if states[name] == "running":
        return (f"{name} is running; stop it first: "
                f"rosrun controller_manager controller_manager stop {name}")
    return SEE_LOG


def switch_failure(listed: Sequence[ControllerState], start: Collection[str],
                   stop: Collection[str]) -> str:
    """Why a strict switch was refused, given what the manager lists afterwards."""
    states = {s.name: s.state for s in listed}
    reasons = []
    if unknown := [name for name in (*start, *stop) if name not in states]:
        reasons.append(f"not loaded: {_listing(unknown)} (loaded: {_listing(states)})")
    if running := [name for name in start if states.get(name) == "running"]:
        reasons.append(f"running already: {_listing(running)}")
    if idle := [name for name in stop if states.get(name, "running") != "running"]:
        reasons.append(f"not running: {_listing(idle)}")
    return "; ".join(reasons + _conflicts(listed, start, stop)) or SEE_LOG


def _conflicts(listed: Sequence[ControllerState], start: Collection[str],
               stop: Collection[str]) -> list[str]:
    claims: dict[str, list[str]] = defaultdict(list)
    for state in listed:
        if state.name in start or (state.state == "running" and state.name not in stop):
            joints = {j for claim in state.claimed_resources for j in claim.resources}
            for joint in sorted(joints):
                claims[joint].append(state.name)
    return [f"joint {joint} is claimed by {' and '.join(names)}"
            for joint, names in claims.items() if len(names) > 1]
