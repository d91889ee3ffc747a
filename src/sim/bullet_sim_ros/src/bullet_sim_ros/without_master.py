"""A ROS graph within one process, in place of rospy's: to try plugins without a master.

Messages, services and parameters are kept in lists and dictionaries.
"""

import io
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import rospy


@dataclass
class Topic:
    """One topic of the graph; `messages` are those published while their publisher was open."""

    kind: type | None = None
    messages: list = field(default_factory=list)
    publishers: list = field(default_factory=list)
    subscribers: list = field(default_factory=list)
    listeners: int = 0  # other subscribers: what get_num_connections returns


class Graph:
    """Topics, services and parameters by resolved name."""

    def __init__(self):
        self.topics: dict[str, Topic] = defaultdict(Topic)
        self.services: dict[str, tuple[type, Callable]] = {}
        self.parameters: dict[str, object] = {}

    def get_param(self, name: str, *default: object) -> object:
        """A parameter or the tree below a name; KeyError without it and a default."""
        name = rospy.resolve_name(name).rstrip("/")
        if name in self.parameters:
            return self.parameters[name]
        tree: dict = {}
        for key, value in self.parameters.items():
            if key.startswith(f"{name}/"):
                *path, last = key[len(name) + 1:].split("/")
                branch = tree
                for part in path:
                    branch = branch.setdefault(part, {})
                branch[last] = value
        if tree or not default:
            return tree or self.parameters[name]
        return default[0]

    def has_param(self, name: str) -> bool:
        """As rospy's."""
        return self.get_param(name, self) is not self

    def set_param(self, name: str, value: object) -> None:
        """As rospy's."""
        self.parameters[rospy.resolve_name(name)] = value


class Publisher:
    """In place of rospy.Publisher."""

    graph: Graph  # of a subclass

    def __init__(self, name: str, data_class: type, **options):
        self.name, self.resolved_name = name, rospy.resolve_name(name)
        self.options = options
        self._topic = self.graph.topics[self.resolved_name]
        self._topic.kind = data_class
        self._topic.publishers.append(self)

    def publish(self, *args, **fields) -> None:
        """Publish a message, given itself or by its fields."""
        made = args and isinstance(args[0], self._topic.kind)
        message = args[0] if made else self._topic.kind(*args, **fields)
        message.serialize(io.BytesIO())  # an error if it cannot be sent
        if self in self._topic.publishers:
            self._topic.messages.append(message)

    def get_num_connections(self) -> int:
        """The number of other subscribers."""
        return self._topic.listeners

    def unregister(self) -> None:
        """Close the publisher."""
        if self in self._topic.publishers:
            self._topic.publishers.remove(self)


class Subscriber:
    """In place of rospy.Subscriber."""

    graph: Graph  # of a subclass
    impl = None  # no connections of rospy's own

    def __init__(self, name: str, data_class: type, callback=None, callback_args=None,
                 **_options):
        self.resolved_name, self.data_class = rospy.resolve_name(name), data_class
        self.callback, self.args = callback, callback_args
        self._topic = self.graph.topics[self.resolved_name]
        self._topic.kind = self._topic.kind or data_class
        self._topic.subscribers.append(self)

    def take(self, message) -> None:
        """Call the callback with a message."""
        if self.callback is not None:
            self.callback(message, *([] if self.args is None else [self.args]))

    def get_num_connections(self) -> int:
        """One, as if there were a publisher."""
        return 1

    def unregister(self) -> None:
        """End the subscription."""
        if self in self._topic.subscribers:
            self._topic.subscribers.remove(self)


class Service:
    """In place of rospy.Service; rospy.ServiceException if the name is taken."""

    graph: Graph  # of a subclass

    def __init__(self, name: str, service_class: type, handler: Callable, **_options):
        self.resolved_name = rospy.resolve_name(name)
        if self.resolved_name in self.graph.services:
            raise rospy.ServiceException(f"service [{self.resolved_name}] already registered")
        self.graph.services[self.resolved_name] = (service_class, handler)

    def shutdown(self, _reason: str = "") -> None:
        """Remove the service."""
        self.graph.services.pop(self.resolved_name, None)


def stand_ins(graph: Graph) -> dict[str, object]:
    """The replacements of rospy's own by name, which use `graph`."""
    return {**{kind.__name__: type(kind.__name__, (kind,), {"graph": graph})
               for kind in (Publisher, Subscriber, Service)},
            **{name: getattr(graph, name) for name in ("get_param", "has_param", "set_param")}}


@contextmanager
def without_master(caller: str = "/gazebo") -> Iterator[Graph]:
    """Within `with`, rospy has an empty graph and no master; `caller`: the node's own name (~)."""
    graph = Graph()
    places = [(rospy, name, stand_in) for name, stand_in in stand_ins(graph).items()]
    places += [(rospy.rostime, "_rostime_initialized", True),
               (rospy.rostime, "_rostime_current", rospy.Time(0)),
               (rospy.names, "_caller_id", caller)]
    before = [(module, name, getattr(module, name)) for module, name, _ in places]
    for module, name, stand_in in places:
        setattr(module, name, stand_in)
    try:
        yield graph
    finally:
        for module, name, own in before:
            setattr(module, name, own)
