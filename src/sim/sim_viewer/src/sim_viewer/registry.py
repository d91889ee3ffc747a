"""What a browser may request by name, and the context in which it is answered.

Operations are answered once; a watchable's events are sent until the browser ends the watch. A
module of this package registers its own by decorators; `load_all` imports them all:

    @operation("pause", control=True)
    async def pause(context, paused: bool = True):
        await context.run_in_thread(call_service, paused)

    @watchable("echo")
    class Echo:
        def __init__(self, context, args, send): ...   # raise Refused for bad args
        def start(self): ...                           # plain: in a worker thread
        async def stop(self): ...                      # coroutine: in the loop
"""

import asyncio
import importlib
import inspect
import math
import pkgutil
import types
import typing
from collections.abc import Awaitable, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import rospy

import sim_viewer
from sim_viewer.options import Options

WORKERS = 16  # threads for what may block: services, the master, slow encoders


class Node:
    """Shared by all browsers: options, the loop, worker threads and the modules' shared objects."""

    def __init__(self, options: Options, loop: asyncio.AbstractEventLoop):
        self.options = options
        self.loop = loop
        self._workers = ThreadPoolExecutor(WORKERS, thread_name_prefix="worker")
        self._shared: dict[type, Any] = {}

    def shared(self, kind: type) -> Any:
        """The one object of this class, made as `kind(node)` when it is first asked for; in the
        loop's thread only."""
        if kind not in self._shared:
            self._shared[kind] = kind(self)
        return self._shared[kind]

    async def run_in_thread(self, function: Callable, *args: Any) -> Any:
        """Call a function that may block in a worker thread, and return its result."""
        return await self.loop.run_in_executor(self._workers, function, *args)

    def close(self) -> None:
        """Close the shared objects that have a `close`."""
        for shared in self._shared.values():
            if hasattr(shared, "close"):
                shared.close()
        self._workers.shutdown(wait=False, cancel_futures=True)


class Context:
    """One browser's connection."""

    def __init__(self, node: Node, client: int):
        self.node = node
        self.client = client  # a unique number
        self.loop = node.loop
        self._on_close: list[Callable[[], None]] = []

    @property
    def control(self) -> bool:
        """Whether this browser may change anything."""
        return self.node.options.control

    async def run_in_thread(self, function: Callable, *args: Any) -> Any:
        """Call a function that may block in a worker thread, and return its result."""
        return await self.node.run_in_thread(function, *args)

    def on_close(self, function: Callable[[], None]) -> None:
        """Have `function` called in the loop when the connection has ended."""
        self._on_close.append(function)

    def closed(self) -> None:
        """The connection has ended: call all functions of `on_close`, even if one of them fails."""
        for function in self._on_close:
            try:
                function()
            except Exception as error:
                rospy.logwarn("end of a connection: %s: %s", type(error).__name__, error)


class Refused(Exception):
    """A request that cannot be met; the text is one line: why, and what to do."""


@dataclass(frozen=True)
class Operation:
    """`function` is a coroutine function of a context and keyword arguments."""

    name: str
    control: bool  # whether it changes anything, which only a page with control may
    function: Callable[..., Awaitable[Any]]

    def arguments(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """`given`, checked against the function's names and annotations; else Refused."""
        try:
            bound = inspect.signature(self.function).bind(None, **given)
        except TypeError as error:
            raise Refused(f"{self.name}: {error}") from None
        hints = typing.get_type_hints(self.function)
        for name, value in given.items():
            if name in hints and not _fits(value, hints[name]):
                raise Refused(f"{self.name}: {name} is {_shown(value)}, "
                              f"which is not of type {_type_name(hints[name])}")
        return dict(list(bound.arguments.items())[1:])


_operations: dict[str, Operation] = {}
_watchables: dict[str, type] = {}


def operation(name: str, control: bool = False) -> Callable:
    """Registers a coroutine function `f(context, **args)` under the name that browsers use.

    ValueError if the name is taken.
    """
    def register(function: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
        if name in _operations:
            raise ValueError(f"two operations are called {name}")
        _operations[name] = Operation(name, control, function)
        return function
    return register


def watchable(name: str) -> Callable[[type], type]:
    """Registers a class made by `(context, args, send)`, with `start()` and `stop()`.

    `send(data)` may be called from any thread: data for JSON, or bytes. A browser that is slow gets
    the newest only; `send(data, keep=True)` is for what must not be left out, such as log lines.

    ValueError if the name is taken.
    """
    def register(kind: type) -> type:
        if name in _watchables:
            raise ValueError(f"two things to watch are called {name}")
        _watchables[name] = kind
        return kind
    return register


def find_operation(name: Any) -> Operation:
    """The operation of this name; Refused if there is none."""
    return _find(_operations, name, "operation")


def find_watchable(name: Any) -> type:
    """The watchable of this name; Refused if there is none."""
    return _find(_watchables, name, "thing to watch")


def argument(args: Mapping[str, Any], name: str, kind: Any, default: Any = ...) -> Any:
    """One of a watchable's arguments, checked; Refused where it is missing or of another type."""
    value = args.get(name, default)
    if value is ...:
        raise Refused(f"the argument {name} is missing")
    if name in args and not _fits(value, kind):
        raise Refused(f"{name} is {_shown(value)}, which is not of type {_type_name(kind)}")
    return value


def load_all() -> None:
    """Import every module of the package, each of which registers its operations and watchables."""
    for module in pkgutil.walk_packages(sim_viewer.__path__, "sim_viewer."):
        importlib.import_module(module.name)


def _find(known: Mapping[str, Any], name: Any, what: str) -> Any:
    if not isinstance(name, str) or name not in known:
        raise Refused(f"there is no {what} {_shown(name)}; there are {', '.join(sorted(known))}")
    return known[name]


def _fits(value: Any, kind: Any) -> bool:
    if kind is Any:
        return True
    if typing.get_origin(kind) in (typing.Union, types.UnionType):
        return any(_fits(value, one) for one in typing.get_args(kind))
    kind = typing.get_origin(kind) or kind
    if kind in (int, float) and isinstance(value, bool):
        return False
    if kind is float:
        return isinstance(value, (int, float)) and abs(value) < 1e300 and math.isfinite(value)
    return isinstance(value, kind)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."


def _type_name(kind: Any) -> str:
    return getattr(kind, "__name__", None) or str(kind)
