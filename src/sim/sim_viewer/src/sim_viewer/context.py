"""The context of operations and watchables: one browser's connection, and the node behind it."""

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import rospy

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
