"""Makes a course's nodes obey the course alone, once the submission has started.

Whoever finds a node's port can tell it to hear a publisher of its own, to serve a call, to end:
ROS asks for no permission, and the master learns nothing. So a marked course's Python nodes ask
`Guard.allows` first (see `bullet_sim_ros.rospy_patches.ask_before_obeying`), and record what they
refuse in a file that the sandbox does not show. `guarded/usercustomize.py` loads it into each.
"""

from __future__ import annotations

import json
import os
import threading
import xmlrpc.client
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path

import rosgraph

from run_session.failure import RunError
from run_session.files import find_package, write_whole

FOLDER = "MARKING_GUARD"  # environment variable: the folder of the two files
RECORD, SEAL = "guard.jsonl", "guard.json"


class Guard:
    """In a node's process: decides what it may do on behalf of others."""

    def __init__(self, folder: Path):
        """Record in the folder that this process is guarded; OSError if it cannot."""
        self._folder, self._turn = folder, threading.Lock()
        self._refused: set[tuple[str, str, str]] = set()
        self._rules: Mapping | None = None
        self._write({"guarded": os.getpid()})

    def allows(self, kind: str, name: str, uri: str) -> bool:
        """Whether the node may do it: anything until the submission starts; then it may connect to
        publishers that the master lists, by address, and answer calls that the rules allow."""
        rules = self._sealed()
        if rules is None:
            return True
        if kind == "publisher":
            fine = uri in listed_publishers(_node(), name)
        else:
            fine = kind == "service" and self._may_answer(name, rules)
        if not fine:
            self._record(kind, name, uri)
        return fine

    def _sealed(self) -> Mapping | None:
        """The rules, once the judge has written them."""
        if self._rules is None and (self._folder / SEAL).exists():
            self._rules = json.loads((self._folder / SEAL).read_text(encoding="utf-8"))
        return self._rules

    def _may_answer(self, service: str, rules: Mapping) -> bool:
        with self._turn:
            if service in rules["may_call"]:
                return True
            rules["own_calls"][service] = left = rules["own_calls"].get(service, 0) - 1
            return left >= 0

    def _record(self, kind: str, name: str, uri: str) -> None:
        """Write each refusal once."""
        with self._turn:
            if (kind, name, uri) in self._refused:
                return
            self._refused.add((kind, name, uri))
        self._write({"node": _node(), "refused": kind, "name": name, "uri": uri})

    def _write(self, entry: Mapping) -> None:
        with (self._folder / RECORD).open("a", encoding="utf-8") as file:  # one write: one line
            file.write(json.dumps(entry) + "\n")


def guard_node() -> None:
    """Guard this process's node, in the folder that the environment names."""
    from bullet_sim_ros.rospy_patches import ask_before_obeying

    ask_before_obeying(Guard(Path(os.environ[FOLDER])).allows)


def guard_launch() -> None:
    """Guard roslaunch: what it believes and prints of its processes comes from itself alone.

    It would take anybody for a roslaunch on another machine, of which a marked course has none.
    """
    from roslaunch.server import ROSLaunchParentHandler

    guard = Guard(Path(os.environ[FOLDER]))

    def refuse(_handler, *_call):
        guard.allows("launch", "", "")
        return 0, "refused: this roslaunch has no others", 0

    for method in ("register", "process_died", "log"):
        setattr(ROSLaunchParentHandler, method, refuse)


def environment(folder: Path) -> dict[str, str]:
    """Environment variables that guard all Python nodes of a course; empties the record."""
    (folder / SEAL).unlink(missing_ok=True)
    (folder / RECORD).unlink(missing_ok=True)
    # Where PYTHONNOUSERSITE has a value, Python loads no usercustomize.py.
    return {FOLDER: str(folder), "PYTHONNOUSERSITE": "", "PYTHONPATH": os.pathsep.join(
        [str(find_package("marking") / "guarded"), os.environ.get("PYTHONPATH", "")])}


def seal(folder: Path, may_call: Iterable[str], own_calls: Counter[str]) -> None:
    """From now on refuse what others ask, but for these services; `own_calls`: the judge's own,
    so many of each."""
    rules = {"may_call": sorted(may_call), "own_calls": own_calls}
    write_whole(folder / SEAL, json.dumps(rules).encode())


def check_guarded(master: rosgraph.Master, nodes: Iterable[str], folder: Path) -> None:
    """RunError if one of the nodes, which all run on this machine, is not guarded."""
    entries = map(json.loads, (folder / RECORD).read_text(encoding="utf-8").splitlines())
    guarded = {entry["guarded"] for entry in entries if "guarded" in entry}
    for node in sorted(nodes):
        _, _, pid = xmlrpc.client.ServerProxy(master.lookupNode(node)).getPid("/judge")
        if pid not in guarded:
            raise RunError(f"{node} obeys whoever finds its port: it does not load {__file__}")


def listed_publishers(caller: str, topic: str) -> set[str]:
    """XML-RPC addresses of a topic's publishers by the master; OSError without a master."""
    master = rosgraph.Master(caller)
    publishers, _, _ = master.getSystemState()
    nodes = next((nodes for name, nodes in publishers if name == topic), ())
    addresses = set()
    for node in nodes:
        code, _, address = master.handle.lookupNode(caller, node)
        addresses |= {address} if code == 1 else set()  # else it has just unregistered
    return addresses


def _node() -> str:
    import rospy  # the node's own, which is loaded already

    return rospy.get_name()
