"""The ROS master's state, read at most once a second for any number of pages."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rosgraph
import rospy
from node_basics.listening import roscore
from roslib.message import get_message_class

from sim_viewer.registry import Refused
from sim_viewer.tools import names

OLDEST = 1.0  # s that an answer may be old


@dataclass(frozen=True)
class SystemState:
    """Publishers, subscribers and services: names of nodes by topic or service."""

    publishers: dict[str, list[str]]
    subscribers: dict[str, list[str]]
    services: dict[str, list[str]]


class MasterView:
    """Thread safe; Refused if the master is gone."""

    def __init__(self, node: Any = None):
        self._lock = threading.Lock()
        self._known: dict[str, tuple[float, Any]] = {}

    def state(self) -> SystemState:
        """All publishers, subscribers and services. Refused if the master is gone."""
        return self._recent("state", lambda: SystemState(
            *({name: sorted(nodes) for name, nodes in part}
              for part in connect().getSystemState())))

    def types(self) -> dict[str, str]:
        """Each topic's type. Refused if the master is gone."""
        return self._recent("types", lambda: dict(connect().getTopicTypes()))

    def message_class(self, topic: str) -> type:
        """The class of a topic's messages; Refused if there is no such topic or class."""
        kind = self.types().get(topic)
        if kind is None or kind == "*":
            raise Refused(f"{topic}: no such topic. The Topics tab lists what there is")
        found = get_message_class(kind)
        if found is None:
            raise Refused(f"{topic} is {kind}, which is not built here: build its package, "
                          "source its workspace and start the page again")
        return found

    def _recent(self, what: str, ask: Callable[[], Any]) -> Any:
        with self._lock:
            moment, answer = self._known.get(what, (-OLDEST, None))
            if time.monotonic() - moment < OLDEST:
                return answer
            answer = asked(ask)
            self._known[what] = (time.monotonic(), answer)
            return answer


def connect() -> rosgraph.Master:
    """A new connection for the caller alone: they cannot be shared between threads."""
    return rosgraph.Master(rospy.get_name())


def asked(ask: Callable[[], Any]) -> Any:
    """The master's answer; Refused if there is none."""
    try:
        return ask()
    except OSError as error:
        raise Refused(f"the ROS master does not answer ({error.strerror or error}); start "
                      f"{roscore(rosgraph.get_master_uri())} or your launch file, and this page "
                      "comes back") from None
    except rosgraph.MasterException as error:
        raise Refused(f"the ROS master refused: {error}") from None


def simulator_name(state: SystemState) -> str:
    """The node that can be paused; /gazebo if there is none or it is one of several."""
    found = sorted(service.removesuffix(names.PAUSE) for service in state.services
                   if service.endswith(names.PAUSE))
    return names.GAZEBO if names.GAZEBO in found or not found else found[0]
